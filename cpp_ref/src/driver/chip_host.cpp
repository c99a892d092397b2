// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cchip/certify.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/driver/chip_host.hpp>
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/judge/face_pairs.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <iterator>
#include <list>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "line_allocator.hpp"

namespace cchip {
namespace {

constexpr std::uint64_t most_image_lines = std::uint64_t{1} << 24U;

/// A port until it dies. Calls of a dead one return what they are told to, and do nothing.
class Chip {
 public:
  explicit Chip(std::unique_ptr<QueryPort> port) : port_(std::move(port)), capabilities_(port_->capabilities()) {}

  const char* name() const { return port_->name(); }
  const ChipCapabilities& capabilities() const { return capabilities_; }
  bool is_dead() const { return dead_; }
  void kill() { dead_ = true; }

  void store(std::uint32_t first, const std::vector<Line>& lines) {
    call(false, [&] { return port_->store(first, lines), true; });
  }
  bool refit(std::uint32_t first, std::uint32_t lines, std::uint32_t root) {
    return call(false, [&] { return port_->refit(first, lines, root); });
  }
  void lock(unsigned range, std::uint32_t first, std::uint32_t last) {
    call(false, [&] { return port_->lock(range, first, last), true; });
  }
  bool submit(const Query& query) {
    return call(false, [&] { return port_->submit(query); });
  }
  std::optional<QueryOutcome> collect() {
    return call(std::optional<QueryOutcome>(), [&] { return port_->collect(); });
  }
  bool proceed() {
    return call(false, [&] { return port_->proceed(); });
  }
  void recover() {
    if (!call(false, [&] { return port_->recover(); })) dead_ = true;
  }
  void load(ModuleId module_id) {
    call(false, [&] { return port_->load(module_id), true; });
  }
  SwapCounts swaps() {
    return call(SwapCounts{}, [&] { return port_->swaps(); });
  }
  std::uint64_t clocks() {
    return call(std::uint64_t{0}, [&] { return port_->clocks(); });
  }

 private:
  template <class Value, class Action>
  Value call(Value of_dead, const Action& action) {
    if (dead_) return of_dead;
    try {
      return action();
    } catch (const std::runtime_error&) {
      dead_ = true;
      return of_dead;
    }
  }

  std::unique_ptr<QueryPort> port_;
  ChipCapabilities capabilities_;
  bool dead_ = false;
};

/// The image of an object, and where it is in the chip's memory.
struct Stored {
  /// \param by_engine an engine is to make the nodes
  Stored(const Object& of, bool by_engine) : object(of), needs_refit(by_engine) {
    try {
      if (by_engine) {
        image = bvh::make_leaves(of.mesh(), of.tree().topology());
        header = image->header();
      } else {
        make();
      }
    } catch (const std::invalid_argument&) {  // more lines than an image holds
    }
  }
  /// The whole image.
  void make() {
    bvh::Tree tree = object.tree().topology();
    bvh::refit(tree, object.mesh());
    image = bvh::make_image(object.mesh(), tree);
    header = image->header();
    needs_refit = false;
  }
  /// How much of the limit on lines it takes.
  std::uint64_t weight() const { return image ? image->lines.size() : most_image_lines; }

  Object object;  // keeps id() from being given to another object
  std::optional<bvh::Image> image;
  bvh::HeaderLine header;
  bool needs_refit = false;            ///< the nodes of `image` have no volumes
  std::optional<std::uint32_t> first;  ///< line in the chip's memory
  std::size_t in_flight = 0;           ///< queries that use it
};

/// Images of objects, the chip's memory and its locks.
class ImageStore {
 public:
  ImageStore(Chip& chip, const ChipHostOptions& options)
      : chip_(chip), options_(options), memory_(chip.capabilities().image_first, chip.capabilities().image_lines) {}

  /// Makes the image if it is not kept. Valid as long as a query in flight uses it, and until of() was called for two
  /// other objects.
  Stored& of(const Object& object) {
    const auto found =
        std::find_if(items_.begin(), items_.end(), [&object](const Stored& x) { return x.object.id() == object.id(); });
    if (found != items_.end()) {
      items_.splice(items_.begin(), items_, found);
    } else {
      items_.emplace_front(object, chip_.capabilities().refits && object.was_moved());
      lines_ += items_.front().weight();
    }
    trim();
    return items_.front();
  }

  /// Brings both to the chip's memory, which has room for both together. Others leave it, those used least recently
  /// first.
  /// \returns false: images that queries in flight use are in the way
  bool place(Stored& a, Stored& b) {
    if (place_beside(a, b) && place_beside(b, a)) return true;
    const auto is_used = [](const Stored& x) { return x.in_flight != 0; };
    if (std::any_of(items_.begin(), items_.end(), is_used)) return false;
    for (Stored& x : items_) remove(x);  // one of the two may divide what is free
    return place_beside(a, b) && place_beside(b, a);
  }

  /// Locks the top lines of both, as far as the chip has ranges.
  void lock(const Stored& a, const Stored& b) {
    std::array<const Stored*, 2> wanted = {&a, &a == &b ? nullptr : &b};
    const auto has = [this](unsigned range, const Stored* x) { return x != nullptr && locked_[range] == x; };
    if (has(0, wanted[1]) || has(1, wanted[0])) std::swap(wanted[0], wanted[1]);
    for (unsigned range = 0; range < wanted.size() && range < chip_.capabilities().lock_ranges; ++range) {
      const Stored* x = wanted[range];
      if (x == locked_[range] || options_.locked_lines == 0) continue;
      if (x == nullptr) {
        unlock(range);
        continue;
      }
      const std::uint32_t lines = std::min(options_.locked_lines, static_cast<std::uint32_t>(x->image->lines.size()));
      chip_.lock(range, *x->first, *x->first + lines - 1);
      locked_[range] = x;
    }
  }

  /// After a reset of the chip: its memory holds nothing.
  void forget_memory() {
    for (Stored& x : items_) x.first.reset();
    memory_.release_all();
    locked_ = {};
  }

 private:
  void trim() {
    for (auto x = items_.end(); is_too_much() && std::distance(items_.begin(), x) > 2;) {
      --x;
      if (x->in_flight != 0) continue;
      remove(*x);
      lines_ -= x->weight();
      x = items_.erase(x);
    }
  }
  bool is_too_much() const { return items_.size() > options_.kept_images || lines_ > options_.kept_lines; }

  /// Brings x to memory; `other` stays there.
  bool place_beside(Stored& x, const Stored& other) {
    if (x.first) return true;
    const std::vector<Line>& lines = x.image->lines;
    while (!(x.first = memory_.allocate(static_cast<std::uint32_t>(lines.size())))) {
      const auto least = std::find_if(items_.rbegin(), items_.rend(), [&other](const Stored& y) {
        return y.first && y.in_flight == 0 && &y != &other;
      });
      if (least == items_.rend()) return false;
      remove(*least);
    }
    chip_.store(*x.first, lines);
    if (x.needs_refit && !chip_.refit(*x.first, x.header.lines, x.header.root)) {
      x.make();  // the engine gave up
      chip_.store(*x.first, x.image->lines);
    }
    return true;
  }

  /// Frees its place in the chip's memory. Not for images in use.
  void remove(Stored& x) {
    if (!x.first) return;
    for (unsigned range = 0; range < locked_.size(); ++range) {
      if (locked_[range] == &x) unlock(range);
    }
    memory_.release(*x.first);
    x.first.reset();
  }

  void unlock(unsigned range) {
    chip_.lock(range, 1, 0);
    locked_[range] = nullptr;
  }

  Chip& chip_;
  const ChipHostOptions options_;
  LineAllocator memory_;
  std::list<Stored> items_;                   // the last one asked for first
  std::uint64_t lines_ = 0;                   // weight of all
  std::array<const Stored*, 2> locked_ = {};  // by range
};

class ChipHost final : public Device {
 public:
  ChipHost(std::unique_ptr<QueryPort> port, const ChipHostOptions& options)
      : chip_(std::move(port)),
        images_(chip_, options),
        most_in_flight_(std::max<std::size_t>(1, chip_.capabilities().queries_in_flight)) {}

  const char* name() const override { return chip_.name(); }

 private:
  /// A query for the chip.
  struct Prepared {
    CollisionQuery placed;
    Query query;  ///< its bases and its tag are set when it is submitted
    Stored* a;    ///< the user's first object
    Stored* b;
  };
  struct Flight {
    std::size_t number;
    CollisionQuery placed;
    Stored* a;
    Stored* b;
    bool exact;  ///< the chip's map has no error, so primitives that the chip calls a definite contact may only touch
  };
  enum class Submission { done, later, never };

  void answer(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    serve(
        1, [&query](std::size_t) { return query; }, request, result, [](std::size_t, const CollisionResult&) {});
    if (request.certificate && !result.certificate) add_certificate(query, request, result);
  }

  void answer_all(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                  const ResultSink& take) override {
    CollisionResult result;
    if (!request.certificate) return serve(count, query, request, result, take);
    serve(count, query, request, result, [&](std::size_t number, const CollisionResult&) {
      if (!result.certificate) add_certificate(query(number), request, result);  // the CPU's answers have theirs
      take(number, result);
      result.certificate.reset();
    });
  }

  /// \param result where each result is made before `take` gets it
  template <class Source, class Sink>
  void serve(std::size_t count, const Source& query, const CollisionRequest& request, CollisionResult& result,
             const Sink& take) {
    try {
      const Order order(count, query, chip_.capabilities().swap_slots != 0);
      std::optional<Prepared> waiting;  // for room
      for (std::size_t next = 0; next < count || !flights_.empty();) {
        while (next < count) {
          if (!is_loaded(order, next)) break;
          const CollisionQuery placed = waiting ? waiting->placed : query(order[next]);
          if (!waiting) waiting = prepare(placed, request);
          const Submission submission = waiting ? submit(*waiting, order[next]) : Submission::never;
          if (submission == Submission::later) break;
          waiting.reset();
          const std::size_t number = order[next++];
          if (submission == Submission::done) continue;
          fall_back(placed, request, {}, result);
          take(number, result);
        }
        if (next == count && flights_.empty()) return;
        if (const std::optional<QueryOutcome> outcome = chip_.collect()) {
          const std::optional<Flight> flight = land(outcome->done.tag);
          if (!flight) continue;
          finish(*flight, *outcome, request, result);
          take(flight->number, result);
        } else if (!chip_.proceed()) {
          std::vector<Flight> lost = give_up();
          if (lost.empty() && waiting) {  // the chip had no room although nothing was in flight
            lost.push_back({order[next++], waiting->placed, waiting->a, waiting->b, false});
            waiting.reset();
          }
          CollisionStats stats;
          stats.clocks = std::exchange(lost_clocks_, 0);
          for (const Flight& flight : lost) {
            fall_back(flight.placed, request, std::exchange(stats, {}), result);
            take(flight.number, result);
          }
        }
      }
    } catch (...) {
      drain();
      throw;
    }
  }

  /// The queries of a batch, for a chip with swaps sorted by the module that they need.
  class Order {
   public:
    template <class Source>
    Order(std::size_t count, const Source& query, bool sorts) {
      if (!sorts) return;
      std::map<const void*, bool> quads;  // by object
      const auto has_quads = [&quads](const Object& object) {
        const auto [found, is_new] = quads.emplace(object.id(), false);
        if (is_new) {
          const std::vector<Mesh::Face>& faces = object.mesh().faces;
          found->second =
              std::any_of(faces.begin(), faces.end(), [](const Mesh::Face& face) { return face.kind == Kind::quad; });
        }
        return found->second;
      };
      for (std::size_t i = 0; i < count; ++i) {
        const CollisionQuery placed = query(i);
        const int quad_objects = (has_quads(*placed.a) ? 1 : 0) + (has_quads(*placed.b) ? 1 : 0);
        modules_.push_back(static_cast<ModuleId>(1 + quad_objects));
        order_.push_back(i);
      }
      std::stable_sort(order_.begin(), order_.end(),
                       [this](std::size_t x, std::size_t y) { return modules_[x] < modules_[y]; });
    }
    std::size_t operator[](std::size_t place) const { return order_.empty() ? place : order_[place]; }
    bool sorts() const { return !order_.empty(); }
    ModuleId module_at(std::size_t place) const { return modules_[order_[place]]; }
    /// The module after that at this place; the same if there is none.
    ModuleId module_after(std::size_t place) const {
      const ModuleId now = module_at(place);
      while (place < order_.size() && module_at(place) == now) ++place;
      return place < order_.size() ? module_at(place) : now;
    }

   private:
    std::vector<std::size_t> order_;
    std::vector<ModuleId> modules_;
  };

  /// Asks for the module of the query at this place, with two slots also for the one after it.
  /// \returns false: queries in flight need another one
  bool is_loaded(const Order& order, std::size_t place) {
    if (!order.sorts()) return true;
    const ModuleId module_id = order.module_at(place);
    if (!flights_.empty()) return module_id == module_;
    if (place != 0 && module_id == module_) return true;
    module_ = module_id;
    chip_.load(module_);
    const ModuleId next = order.module_after(place);
    if (chip_.capabilities().swap_slots > 1 && next != module_) chip_.load(next);
    return true;
  }

  /// The query as the chip takes it; none if it does not.
  std::optional<Prepared> prepare(const CollisionQuery& placed, const CollisionRequest& request) {
    if (chip_.is_dead() || request.within > 0) return std::nullopt;
    Stored& a = images_.of(*placed.a);
    Stored& b = images_.of(*placed.b);
    const ChipCapabilities& chip = chip_.capabilities();
    if (!a.image || !b.image) return std::nullopt;
    if (a.image->lines.size() + (&a == &b ? 0 : b.image->lines.size()) > chip.image_lines) return std::nullopt;
    if (!chip.quads && (a.header.has_quads || b.header.has_quads)) return std::nullopt;
    std::optional<Query> query = bvh::make_query(a.header, *placed.pose_a, b.header, *placed.pose_b);
    if (!query) return std::nullopt;
    // A FIRST query ends with a definite contact. If the numbers are exact, that one may only touch.
    const bool needs_all =
        request.contacts == CollisionRequest::Contacts::all || (request.tells_relation() && query->error == 0);
    query->mode = needs_all ? QueryMode::all : QueryMode::first;
    return Prepared{placed, *query, &a, &b};
  }

  Submission submit(Prepared& x, std::size_t number) {
    if (flights_.size() >= most_in_flight_ || !images_.place(*x.a, *x.b)) return Submission::later;
    if (flights_.empty()) {
      images_.lock(*x.a, *x.b);
      mark_ = chip_.clocks();
    }
    x.query.base_a = x.query.swapped ? *x.b->first : *x.a->first;
    x.query.base_b = x.query.swapped ? *x.a->first : *x.b->first;
    x.query.tag = next_tag_;
    if (!chip_.submit(x.query)) return chip_.is_dead() ? Submission::never : Submission::later;
    flights_.emplace(next_tag_++, Flight{number, x.placed, x.a, x.b, x.query.error == 0});
    ++x.a->in_flight;
    ++x.b->in_flight;
    return Submission::done;
  }

  /// Ends the flight with this tag; none if there is none.
  std::optional<Flight> land(std::uint32_t tag) {
    const auto found = flights_.find(tag);
    if (found == flights_.end()) return std::nullopt;
    const Flight flight = found->second;
    flights_.erase(found);
    --flight.a->in_flight;
    --flight.b->in_flight;
    return flight;
  }

  /// Makes the result of a query that has ended.
  void finish(const Flight& flight, const QueryOutcome& outcome, const CollisionRequest& request,
              CollisionResult& result) {
    CollisionStats stats;
    stats.steps = outcome.done.steps;
    stats.box_tests = outcome.box_tests;
    stats.pairs = outcome.primitive_pairs;
    stats.clocks = clocks_since_mark();
    const SwapCounts swaps = chip_.swaps();
    stats.swaps = swaps.swaps - swaps_.swaps;
    stats.swap_clocks = swaps.clocks - swaps_.clocks;
    swaps_ = swaps;
    const QueryCode code = outcome.done.code;
    if ((code == QueryCode::ok || code == QueryCode::host) && is_well_formed(flight, outcome)) {
      faces_.start(flight.placed, request, result);
      stats.open = resolve(outcome.pairs, request.tells_relation() && flight.exact, faces_);
      if (code == QueryCode::ok || faces_.done()) {
        faces_.finish();
        result.stats = stats;
        return;
      }
    }
    fall_back(flight.placed, request, stats, result);
  }

  static bool is_well_formed(const Flight& flight, const QueryOutcome& outcome) {
    const std::size_t faces_a = flight.placed.a->mesh().faces.size();
    const std::size_t faces_b = flight.placed.b->mesh().faces.size();
    return outcome.done.pairs == outcome.pairs.size() &&
           std::all_of(outcome.pairs.begin(), outcome.pairs.end(), [&](const PairRecord& pair) {
             return pair.tag == outcome.done.tag && pair.id_a < faces_a && pair.id_b < faces_b;
           });
  }

  /// Decides open pairs exactly until the request is fulfilled. The last pair goes first: the chip ends a FIRST query
  /// with the pair that is in contact for certain, and that crosses unless its numbers are exact.
  /// \returns how many pairs were decided here
  static std::uint64_t resolve(const std::vector<PairRecord>& pairs, bool definite_may_touch, FacePairs& faces) {
    std::uint64_t open = 0;
    for (auto pair = pairs.rbegin(); pair != pairs.rend() && !faces.done(); ++pair) {
      if (pair->definite && !definite_may_touch) {
        faces.add(pair->id_a, pair->id_b);
      } else {
        faces.test(pair->id_a, pair->id_b);
        ++open;
      }
    }
    return open;
  }

  /// Answers by the CPU. \param stats what the chip has spent on the query
  void fall_back(const CollisionQuery& placed, const CollisionRequest& request, const CollisionStats& stats,
                 CollisionResult& result) {
    cpu_->collide(placed, request, result);
    result.stats += stats;
    ++result.stats.fallbacks;
  }

  /// Ends all flights without their outcomes, and resets the chip.
  std::vector<Flight> give_up() {
    std::vector<Flight> lost;
    if (!flights_.empty()) lost_clocks_ = clocks_since_mark();
    while (!flights_.empty()) lost.push_back(*land(flights_.begin()->first));
    chip_.recover();
    images_.forget_memory();
    return lost;
  }

  /// Waits until nothing is in flight, and drops what comes.
  void drain() {
    try {
      while (!flights_.empty()) {
        if (const std::optional<QueryOutcome> outcome = chip_.collect()) {
          land(outcome->done.tag);
        } else if (!chip_.proceed()) {
          give_up();
        }
      }
    } catch (...) {  // no memory, or a port that throws what it may not
      chip_.kill();
      while (!flights_.empty()) land(flights_.begin()->first);
      images_.forget_memory();
    }
  }

  /// Clocks since this was called last, or since a query was submitted while none was in flight.
  std::uint64_t clocks_since_mark() {
    const std::uint64_t now = chip_.clocks();
    const std::uint64_t since = now - std::min(now, mark_);
    mark_ = std::max(now, mark_);
    return since;
  }

  Chip chip_;
  ImageStore images_;
  const std::size_t most_in_flight_;
  std::map<std::uint32_t, Flight> flights_;  // by tag
  std::uint32_t next_tag_ = 0;               // an outcome of a flight that was given up finds no other with its tag
  std::uint64_t mark_ = 0;                   // clocks
  ModuleId module_ = ModuleId::blank;        // asked for last
  SwapCounts swaps_;                         // told of
  std::uint64_t lost_clocks_ = 0;            // of flights that were given up
  FacePairs faces_;
  std::unique_ptr<Device> cpu_ = open_cpu_device({1, {}});
};

}  // namespace

std::unique_ptr<Device> make_chip_device(std::unique_ptr<QueryPort> port, const ChipHostOptions& options) {
  if (!port) throw std::invalid_argument("make_chip_device: no port; give one of a chip");
  return std::make_unique<ChipHost>(std::move(port), options);
}

}  // namespace cchip
