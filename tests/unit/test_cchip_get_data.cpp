// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/get_data.hpp>
#include <cchip/stimulus/boundary.hpp>
#include <deque>
#include <map>
#include <models/cchip_get_data.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::GetData;
using model::LineData;

/// Chances in per cent on a clock.
struct Behaviour {
  const char* name = "usual";
  int request = 40;
  int leaf = 30;     ///< of a request: leaves
  int answer = 60;   ///< the cache answers, at each port
  int oldest = 0;    ///< it answers in order, else in any
  int together = 0;  ///< its ports answer alike
  int ready = 60;    ///< of the box test
  int taken = 50;    ///< a leaf pair by its receiver
  int pose = 20;     ///< a context that waits gets its pose
  int error = 5;     ///< of a line: could not be read
  int wrong = 10;    ///< of a line: a field is not what it should be
  int reset = 2;     ///< per mille
};
using B = Behaviour;
const std::vector<B> behaviours = {
    changed<B>("fast", {{&B::request, 100},
                        {&B::leaf, 3},
                        {&B::answer, 100},
                        {&B::oldest, 1},
                        {&B::together, 1},
                        {&B::ready, 100},
                        {&B::taken, 100},
                        {&B::pose, 100},
                        {&B::error, 0},
                        {&B::wrong, 0},
                        {&B::reset, 0}}),
    B{},
    changed<B>("box test", {{&B::request, 60},
                            {&B::leaf, 10},
                            {&B::answer, 80},
                            {&B::ready, 10},
                            {&B::taken, 80},
                            {&B::pose, 30},
                            {&B::wrong, 20}}),
    changed<B>("slow cache",
               {{&B::request, 60}, {&B::leaf, 14}, {&B::answer, 10}, {&B::taken, 30}, {&B::pose, 30}, {&B::wrong, 20}}),
    changed<B>("poses late", {{&B::request, 50}, {&B::ready, 70}, {&B::pose, 2}, {&B::error, 0}, {&B::wrong, 5}}),
    changed<B>("leaves", {{&B::request, 100},
                          {&B::leaf, 90},
                          {&B::answer, 100},
                          {&B::ready, 100},
                          {&B::taken, 8},
                          {&B::pose, 50},
                          {&B::error, 30},
                          {&B::reset, 0}}),
    changed<B>("hits", {{&B::request, 100},
                        {&B::leaf, 40},
                        {&B::answer, 90},
                        {&B::oldest, 1},
                        {&B::together, 1},
                        {&B::ready, 90},
                        {&B::taken, 5},
                        {&B::pose, 50},
                        {&B::error, 10},
                        {&B::reset, 3}}),
    changed<B>("errors", {{&B::pose, 40}, {&B::error, 20}, {&B::wrong, 25}}),
    changed<B>("resets", {{&B::request, 50},
                          {&B::leaf, 10},
                          {&B::together, 1},
                          {&B::pose, 40},
                          {&B::error, 10},
                          {&B::wrong, 20},
                          {&B::reset, 25}}),
};

void set_field(LineData& data, std::size_t lsb, std::size_t width, std::uint64_t value) {
  for (std::size_t bit = lsb; bit < lsb + width; ++bit, value >>= 1) {
    const std::uint32_t mask = 1U << (bit % 32);
    data[bit / 32] = (value & 1) != 0 ? data[bit / 32] | mask : data[bit / 32] & ~mask;
  }
}

template <class Config>
class GetDataBench {
 public:
  static constexpr std::size_t contexts = Config::QUERIES;
  static constexpr std::size_t pairs = Config::PAIRS;
  static constexpr std::size_t places = Config::PAIRS + Config::LEAVES;
  static constexpr int leaf_room = Config::LEAF_ROOM;
  static constexpr int log2(std::size_t n) { return n == 1 ? 0 : 1 + log2(n / 2); }
  static constexpr int context_w = log2(contexts);
  static constexpr int place_w = log2(places);

  GetDataBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation),
        top_(simulation.top()),
        random_(random),
        model_(contexts, pairs, Config::LEAVES, leaf_room) {
    clear();
    step(true);
  }

  void run(const Behaviour& how, int clocks) {
    how_ = how;
    for (int clock = 0; clock < clocks; ++clock) {
      in_ = GetData::Inputs{};
      if (chance(random_, how.request)) in_.request = any_request();
      for (std::size_t c = 0; c < contexts; ++c) {
        if ((!awaits_pose_[c] && random_() % 16 == 0) || (awaits_pose_[c] && chance(random_, how.pose))) in_.pose = c;
      }
      any_lines();
      in_.pair_ready = soon_;
      soon_ = !soon_ && pair_clocks_ > 0 && chance(random_, how.ready);
      in_.leaf_taken = leaves_there_ > 0 && chance(random_, how.taken);
      if (chance(random_, 30)) in_.lookup = random_() % places;
      step(static_cast<int>(random_() % 1000) < how.reset);
    }
    how_.answer = how_.ready = how_.pose = how_.taken = 100;  // what is in flight ends
    how_.request = how_.reset = 0;
    for (int clock = 0; clock < 40 * static_cast<int>(places) && under_way() != 0; ++clock) {
      in_ = GetData::Inputs{};
      for (std::size_t c = 0; c < contexts; ++c) {
        if (awaits_pose_[c]) in_.pose = c;
      }
      any_lines();
      in_.pair_ready = soon_;
      soon_ = !soon_ && pair_clocks_ > 0;
      in_.leaf_taken = leaves_there_ > 0;
      step(false);
    }
    REQUIRE(under_way() == 0);
    in_ = GetData::Inputs{};
    for (int clock = 0; clock < 20; ++clock) step(false);
    REQUIRE(top_.m_pair_valid == 0);
    for (std::size_t place = 0; place < places; ++place) {  // what was found out about every node pair
      in_.lookup = place;
      step(false);
    }
  }

  /// One request, lines at these ports after these clocks; clocks from the second line to the pair.
  int latency(bool leaf, int a, int b) {
    in_ = GetData::Inputs{};
    step(true);
    in_.request = header_request(0, leaf ? pairs : 0);
    if (leaf) in_.request->record = 1;
    in_.pose.reset();
    for (int clock = 0;; ++clock) {
      if (top_.m_pair_valid != 0 || top_.m_leaf_valid != 0) return clock - std::max(a, b);
      REQUIRE(clock < 60);
      in_.lines = {};
      if (clock == 1) in_.pose = 0;
      if (clock == 1) asked_[0].clear(), asked_[1].clear();
      if (clock == a) in_.lines[0] = GetData::Line{leaf ? pairs : 0, ReadCode::ok, {}};
      if (clock == b) in_.lines[1] = GetData::Line{leaf ? pairs : 0, ReadCode::ok, {}};
      for (std::size_t p = 0; p < 2; ++p) {
        if (in_.lines[p]) expected_[in_.lines[p]->place].lines[p] = in_.lines[p];
      }
      step(false);
      in_.request.reset();
      in_.pose.reset();
    }
  }

  int pairs_out = 0;
  int leaves_out = 0;
  int failed_out = 0;
  int looked = 0;                    ///< lookups of nodes that were known
  std::map<GetData::End, int> ends;  ///< of those
  int stalled = 0;
  int fullest = 0;     ///< leaves with their receiver, at most
  int closest = 1000;  ///< clocks from a node pair to the next, at least
  int closest_leaves = 1000;

 private:
  enum class Use { free, wanted, out, done };  // done: its verdict has not come
  struct Expected {
    Use use = Use::free;
    GetData::Request request;
    std::array<std::optional<GetData::Line>, 2> lines;
    int clocks = 0;  // since it went out
  };

  std::size_t under_way() const {
    return static_cast<std::size_t>(
        std::count_if(expected_.begin(), expected_.end(), [](const Expected& one) { return one.use == Use::wanted; }));
  }
  void clear() {
    expected_.assign(places, Expected{});
    awaits_pose_.assign(contexts, false);
    has_header_.assign(contexts, false);
    header_out_.assign(contexts, false);
    sizes_.assign(contexts, {});
    asked_[0].clear();
    asked_[1].clear();
    stays_ = false;
    soon_ = false;
    pair_clocks_ = 0;
    leaves_there_ = 0;
    second_ = {};
    model_second_.reset();
    second_out_.reset();
    model_leaf_.reset();
    leaf_out_.reset();
  }

  // ---- who asks
  GetData::Request header_request(std::size_t context, std::size_t place) {
    GetData::Request request;
    request.place = place;
    request.context = context;
    request.record = std::uint64_t{1} << 58 | random_() % 4 << 56;
    request.lines = {static_cast<std::uint32_t>(random_()), static_cast<std::uint32_t>(random_())};
    return request;
  }
  std::optional<GetData::Request> any_request() {
    const bool leaf = chance(random_, how_.leaf);
    std::vector<std::size_t> free;
    for (std::size_t place = leaf ? pairs : 0; place < (leaf ? places : pairs); ++place) {
      if (expected_[place].use == Use::free) free.push_back(place);
    }
    if (free.empty()) return std::nullopt;
    const std::size_t place = free[random_() % free.size()];
    const std::size_t context = random_() % contexts;
    GetData::Request request = header_request(context, place);
    if (!leaf && header_out_[context]) return std::nullopt;
    if (!leaf && (!has_header_[context] || random_() % 16 == 0)) {
      // node pairs of the query before may still be in flight; their results are not used
      header_out_[context] = true;
      return request;
    }
    request.record = random_() >> 6;  // bit 58 is 0
    if (!leaf && random_() % 4 == 0) {
      const std::uint64_t at = any_of({0, 1, 2, 0xfffffe, 0xffffff});
      request.record = (request.record & ~(std::uint64_t{0xffffff} << 28 | 0xffffff)) | at << 28 | at;
    }
    return request;
  }
  std::uint64_t any_of(std::initializer_list<std::uint64_t> list) { return list.begin()[random_() % list.size()]; }

  // ---- the cache
  void any_lines() {
    const bool both = how_.together && chance(random_, how_.answer);
    for (std::size_t p = 0; p < 2; ++p) {
      auto& asked = asked_[p];
      if (second_[p]) continue;
      if (asked.empty() || (how_.together ? !both : !chance(random_, how_.answer))) continue;
      const auto at = asked.begin() + static_cast<std::ptrdiff_t>(how_.oldest ? 0 : random_() % asked.size());
      Expected& one = expected_[*at];
      one.lines[p] = any_line(p, one.request);
      in_.lines[p] = one.lines[p];
      asked.erase(at);
    }
  }
  /// Near what is checked of it.
  GetData::Line any_line(std::size_t p, const GetData::Request& request) {
    GetData::Line line;
    line.place = request.place;
    for (std::uint32_t& word : line.data) word = static_cast<std::uint32_t>(random_());
    if (chance(random_, how_.error)) line.code = static_cast<ReadCode>(1 + random_() % 3);
    const auto right = [&] { return !chance(random_, how_.wrong); };
    if ((request.record >> 58 & 1) != 0) {
      if (right()) set_field(line.data, 0, 32, 0x4D494343);
      if (!right()) line.data[0] ^= 1U << random_() % 32;
      if (right()) set_field(line.data, 64, 16, 1);
      if (!right()) line.data[2] ^= 1U << random_() % 16;
      const std::uint64_t full = std::uint64_t{1} << 24;
      std::uint64_t size =
          any_of({full, full - 1, full - 2, random_() % full, 1 + random_() % 8, random_() % (full / 16)});
      if (!right())
        size = any_of({0, full + random_() % 8, 2 * full - 1, 2 * full, 2 * full + 3, 0xffffffff, random_()});
      set_field(line.data, 96, 32, size);
      const std::uint64_t root = any_of({0, std::min(size, full) - 1, random_() % full});
      set_field(line.data, 128, 24, right() ? std::min(root, size - 1) : any_of({size, size + 1, full - 1, root}));
      sizes_[request.context][p] = size;
    } else {
      if (right()) set_field(line.data, 54, 5, any_of({0, 17, 18}));
      if (!right()) set_field(line.data, 54, 5, any_of({19, 24, 31}));
      for (std::size_t i = 0; i < 12; ++i) {  // boxes: most are legal, a point at an end of the range included
        std::int64_t least = stimulus::draw(random_, -64, 63);
        std::int64_t greatest = chance(random_, 20) ? least : stimulus::draw(random_, -64, 63);
        if (least > greatest) std::swap(least, greatest);
        if (chance(random_, how_.wrong) && chance(random_, 10)) {  // inverted by 1, or by as much as there is
          const bool far = chance(random_, 50);
          least = far ? 63 : stimulus::draw(random_, -63, 63);
          greatest = far ? -64 : least - 1;
        }
        const std::size_t at = 96 + 102 * (i / 3) + 14 * (i % 3);
        set_field(line.data, at, 7, static_cast<std::uint64_t>(least) & 127);
        set_field(line.data, at + 7, 7, static_cast<std::uint64_t>(greatest) & 127);
      }
      const std::uint64_t more = random_() % 4;
      set_field(line.data, 91, 2, more);
      const std::uint64_t at = request.record >> (28 * p) & 0xffffff;
      const std::uint64_t size = sizes_[request.context][p];
      std::uint64_t first = any_of({at + 1, size - more - 1, size - more - 1, 0xffffff});
      if (!right()) first = any_of({0, at, at - 1, size - more, size, random_(), 0xfffffe, 0xffffff});
      set_field(line.data, 59, 24, first);
    }
    return line;
  }

  // ---- a clock
  void step(bool reset) {
    top_.rst = reset ? 1 : 0;
    drive();
    simulation_.settle();
    if (defined_) compare();
    if (defined_ && random_() % 16 == 0) require_registers();
    if (reset) {
      model_.reset();
      clear();
    } else {
      follow();
      model_.clock(in_);
    }
    defined_ = defined_ || reset;
    simulation_.rise();
  }

  void drive() {
    sim::set_random(top_.s_place, place_w, random_);
    sim::set_random(top_.s_context, context_w, random_);
    sim::set_random(top_.s_record, 59, random_);
    sim::set_random(top_.s_lines, 64, random_);
    sim::set_random(top_.s_pose_context, context_w, random_);
    sim::set_random(top_.s_line_place, 2 * place_w, random_);
    sim::set_random(top_.s_line_code, 4, random_);
    sim::set_random(top_.s_line_data, 512, random_);
    sim::set_random(top_.lookup_place, place_w, random_);
    top_.s_valid = in_.request ? 1 : 0;
    if (in_.request) {
      sim::set_bits(top_.s_place, 0, place_w, in_.request->place);
      sim::set_bits(top_.s_context, 0, context_w, in_.request->context);
      sim::set_bits(top_.s_record, 0, 59, in_.request->record);
      for (int p = 0; p < 2; ++p)
        sim::set_bits(top_.s_lines, 32 * p, 32, in_.request->lines[static_cast<std::size_t>(p)]);
    }
    top_.s_pose_valid = in_.pose ? 1 : 0;
    if (in_.pose) sim::set_bits(top_.s_pose_context, 0, context_w, *in_.pose);
    for (int p = 0; p < 2; ++p) {
      const auto& line = in_.lines[static_cast<std::size_t>(p)];
      const auto& before = second_[static_cast<std::size_t>(p)];
      sim::set_bits(top_.s_line_valid, p, 1, line ? 1 : 0);
      if (!line && !before) continue;
      const GetData::Line& shown = line ? *line : *before;
      sim::set_bits(top_.s_line_place, place_w * p, place_w, shown.place);
      if (line) sim::set_bits(top_.s_line_code, 2 * p, 2, static_cast<unsigned>(line->code));
      for (std::size_t w = 0; w < 8; ++w)
        top_.s_line_data.at(8 * static_cast<std::size_t>(p) + w) = shown.data[(line ? 0 : 8) + w];
    }
    top_.m_pair_soon = soon_ ? 1 : 0;
    top_.s_leaf_taken = in_.leaf_taken ? 1 : 0;
    top_.lookup = in_.lookup ? 1 : 0;
    if (in_.lookup) sim::set_bits(top_.lookup_place, 0, place_w, *in_.lookup);
  }

  void compare() {
    const auto& ask = model_.ask();
    REQUIRE(top_.m_line_valid == (ask ? 3 : 0));
    for (int p = 0; ask && p < 2; ++p) {
      REQUIRE(sim::get_bits(top_.m_line_place, place_w * p, place_w) == ask->place);
      REQUIRE(sim::get_bits(top_.m_line, 32 * p, 32) == ask->lines[static_cast<std::size_t>(p)]);
    }
    REQUIRE((top_.m_pair_valid != 0) == model_.pair_valid());
    REQUIRE((top_.m_leaf_valid != 0) == model_.leaf_valid());
    if (model_second_) require_beat(*model_second_, 1);
    model_second_.reset();
    if (model_.pair_valid() && !stays_) {
      require_beat(model_.pair().lines, 0);
      model_second_ = model_.pair().lines;
    }
    REQUIRE((top_.m_leaf_left != 0) == model_.leaf_left());
    if (model_.leaf_valid()) model_leaf_ = Leaving{model_.leaf().lines};
    require_part(model_leaf_);
    if (model_.pair_valid()) {
      const GetData::Pair& pair = model_.pair();
      REQUIRE(top_.m_pair_place == pair.place);
      REQUIRE(top_.m_pair_context == pair.context);
      REQUIRE(top_.m_pair_children == ((pair.record >> 52 & 15) << 4 | (pair.record >> 24 & 15)));
    }
    if (model_.leaf_valid()) {
      const GetData::Pair& pair = model_.leaf();
      REQUIRE(top_.m_leaf_place == pair.place);
      REQUIRE(top_.m_leaf_context == pair.context);
      REQUIRE(top_.m_leaf_epoch == (pair.record >> 56 & 3));
      REQUIRE(top_.m_leaf_kinds == ((pair.record >> 28 & 3) << 2 | (pair.record & 3)));
      REQUIRE((top_.m_leaf_failed != 0) == pair.failed());
    }
    const GetData::Known& known = model_.known();
    if (known.request) {
      REQUIRE(top_.lookup_context == known.request->context);
      REQUIRE(top_.lookup_record == known.request->record);
    }
    if (known.nodes) {
      REQUIRE(sim::get_bits(top_.lookup_nodes, 64, 3) == static_cast<unsigned>(known.nodes->end));
      for (int p = 0; p < 2; ++p) {
        const GetData::Node& node = known.nodes->nodes[static_cast<std::size_t>(p)];
        REQUIRE(sim::get_bits(top_.lookup_nodes, 32 * p, 24) == node.first);
        if (node.kinds) REQUIRE(sim::get_bits(top_.lookup_nodes, 32 * p + 24, 8) == *node.kinds);
      }
      ++looked;
      ++ends[known.nodes->end];
    }
  }
  void require_beat(const std::array<GetData::Line, 2>& lines, std::size_t beat) {
    for (std::size_t w = 0; w < 16; ++w) REQUIRE(top_.m_lines.at(w) == lines[w / 8].data[8 * beat + w % 8]);
  }

  /// A leaf pair whose beats leave.
  struct Leaving {
    std::array<GetData::Line, 2> lines;
    std::size_t beat = 0;
  };
  void require_part(std::optional<Leaving>& leaving) {
    if (!leaving) return;
    for (std::size_t w = 0; w < 4; ++w)
      REQUIRE(top_.m_leaf_lines.at(w) == leaving->lines[w / 2].data[2 * leaving->beat + w % 2]);
    if (++leaving->beat == 8) leaving.reset();
  }

  /// Independent of the model: every request is asked for once, and leaves once, with its lines, when both have come.
  void follow() {
    for (Expected& one : expected_) {
      if (one.use == Use::out) ++one.clocks;
      if (one.use == Use::out && one.clocks > 4 && random_() % 8 == 0) {  // the verdict
        if ((one.request.record >> 58 & 1) != 0) {
          header_out_[one.request.context] = false;
          has_header_[one.request.context] = true;
        }
        one.use = Use::free;
      }
    }
    if (second_out_) require_beat(*second_out_, 1);
    second_out_.reset();
    if (top_.m_leaf_valid != 0) {
      REQUIRE(!leaf_out_);  // the beats of the one before have left
      leaf_out_ = Leaving{lines_of(top_.m_leaf_place)};
    }
    REQUIRE((top_.m_leaf_left != 0) == (leaf_out_ && leaf_out_->beat == 7));
    require_part(leaf_out_);
    if (top_.m_pair_valid != 0 && !stays_) {
      second_out_ = lines_of(top_.m_pair_place);
      require_beat(*second_out_, 0);
    }
    second_ = in_.lines;
    if (top_.m_line_valid != 0) {
      const std::size_t place = sim::get_bits(top_.m_line_place, 0, place_w);
      REQUIRE(expected_[place].use == Use::wanted);
      REQUIRE(!expected_[place].lines[0]);
      for (auto& asked : asked_) {
        REQUIRE(std::find(asked.begin(), asked.end(), place) == asked.end());
        asked.push_back(place);
      }
    }
    if (in_.request) {
      const GetData::Request& request = *in_.request;
      expected_[request.place] = Expected{Use::wanted, request, {}, 0};
    }
    if (in_.pose) awaits_pose_[*in_.pose] = false;
    if (in_.request && (in_.request->record >> 58 & 1) != 0) awaits_pose_[in_.request->context] = true;
    const auto comes = [this](bool now, int& last, int& least) {
      if (!now) return;
      least = std::min(least, clocks_ - last);
      last = clocks_;
    };
    comes(top_.m_pair_valid != 0 && !stays_, last_pair_, closest);
    comes(top_.m_leaf_valid != 0, last_leaf_, closest_leaves);
    ++clocks_;
    pair_clocks_ = top_.m_pair_valid != 0 && !in_.pair_ready ? pair_clocks_ + 1 : 0;
    stays_ = top_.m_pair_valid != 0 && !in_.pair_ready;
    stalled += stays_ ? 1 : 0;
    if (top_.m_pair_valid != 0 && in_.pair_ready) leave(top_.m_pair_place, Use::out);
    leaves_there_ -= in_.leaf_taken ? 1 : 0;
    if (top_.m_leaf_left != 0) leave(top_.m_leaf_place, Use::free);
    if (top_.m_leaf_valid != 0) {
      REQUIRE(++leaves_there_ <= leaf_room);
      fullest = std::max(fullest, leaves_there_);
    }
  }
  std::array<GetData::Line, 2> lines_of(std::size_t place) const {
    const Expected& one = expected_[place];
    REQUIRE(one.lines[0].has_value());
    REQUIRE(one.lines[1].has_value());
    return {*one.lines[0], *one.lines[1]};
  }
  void leave(std::size_t place, Use use) {
    Expected& one = expected_[place];
    REQUIRE(one.use == Use::wanted);
    REQUIRE((use == Use::free) == (place >= pairs));
    REQUIRE(one.lines[0].has_value());
    REQUIRE(one.lines[1].has_value());
    const bool failed = one.lines[0]->code != ReadCode::ok || one.lines[1]->code != ReadCode::ok;
    if (use == Use::free) REQUIRE((top_.m_leaf_failed != 0) == failed);
    failed_out += failed ? 1 : 0;
    (use == Use::free ? leaves_out : pairs_out) += 1;
    if (use == Use::out && (one.request.record >> 58 & 1) != 0) REQUIRE(!awaits_pose_[one.request.context]);
    one.use = use;
  }

  /// No output follows an input before the rising edge.
  void require_registers() {
    const auto outputs = [&] {
      return std::array<std::uint64_t, 19>{top_.m_line_valid,
                                           top_.m_line_place,
                                           top_.m_line,
                                           top_.m_pair_valid,
                                           top_.m_pair_place,
                                           top_.m_pair_context,
                                           top_.m_pair_children,
                                           top_.m_leaf_valid,
                                           top_.m_leaf_place,
                                           top_.m_leaf_context,
                                           top_.m_leaf_epoch,
                                           top_.m_leaf_kinds,
                                           top_.m_leaf_failed,
                                           top_.m_leaf_left,
                                           top_.m_lines.at(0) ^ top_.m_lines.at(15) ^ top_.m_leaf_lines.at(0),
                                           top_.lookup_context,
                                           top_.lookup_record,
                                           sim::get_bits(top_.lookup_nodes, 0, 64),
                                           sim::get_bits(top_.lookup_nodes, 64, 3)};
    };
    const auto before = outputs();
    const auto rst = top_.rst;
    const GetData::Inputs in = in_;
    in_ = GetData::Inputs{};
    drive();
    top_.rst = 1 - rst;
    top_.s_valid = 1;
    top_.s_line_valid = 3;
    top_.lookup = random_() % 2;
    top_.m_pair_soon = random_() % 2;
    top_.s_leaf_taken = random_() % 2;
    top_.eval();
    REQUIRE(outputs() == before);
    in_ = in;
    drive();
    top_.rst = rst;
    top_.eval();
    REQUIRE(outputs() == before);
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  GetData model_;
  GetData::Inputs in_;
  Behaviour how_{};
  std::vector<Expected> expected_;                   // by place
  std::vector<bool> awaits_pose_;                    // by context
  std::vector<bool> has_header_, header_out_;        // by context
  std::vector<std::array<std::uint64_t, 2>> sizes_;  // by context: near what its headers say
  std::array<std::vector<std::size_t>, 2> asked_;    // places
  bool stays_ = false;
  bool soon_ = false;                                   // the box test takes its pair on the next clock
  int pair_clocks_ = 0;                                 // for which the node pair has been offered
  std::array<std::optional<GetData::Line>, 2> second_;  // lines whose upper halves come
  std::optional<std::array<GetData::Line, 2>> model_second_, second_out_;  // whose upper halves leave
  std::optional<Leaving> model_leaf_, leaf_out_;
  int leaves_there_ = 0;  // with their receiver
  int clocks_ = 0, last_pair_ = -1000, last_leaf_ = -1000;
  bool defined_ = false;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_get_data: outputs are the model's on every clock, every pair leaves once, when both of its lines have come, "
    "with both",
    "[unit][cchip_get_data]", cchip_get_data_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const Behaviour& how : behaviours) {
      CAPTURE(how.name);
      GetDataBench<TestType> bench(simulation, random);
      bench.run(how, 4000);
      REQUIRE(bench.pairs_out > 50);
      REQUIRE(bench.leaves_out > 20);
      if (how.taken <= 5) REQUIRE(bench.fullest == bench.leaf_room);
      REQUIRE(bench.looked > 50);
      REQUIRE((bench.failed_out > 0) == (how.error > 0));
      REQUIRE(bench.ends[GetData::End::ok] > 0);
      if (how.error >= 5 && how.wrong >= 10) {
        for (const auto end :
             {GetData::End::corrupt, GetData::End::outside, GetData::End::bad_descriptor, GetData::End::memory})
          REQUIRE(bench.ends[end] > 0);
      }
      REQUIRE(bench.closest == 3);
      REQUIRE(bench.closest_leaves >= 8);
      if (how.taken == 100 && TestType::LEAVES > 1) REQUIRE(bench.closest_leaves == 8);
      if (how.ready <= 10) REQUIRE(bench.stalled > 500);
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_get_data: latency", "[unit][cchip_get_data]", cchip_get_data_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    GetDataBench<TestType> bench(simulation, random);
    for (const bool leaf : {false, true}) {
      for (const int a : {2, 3, 9}) {
        for (const int b : {2, 3, 8, 12}) REQUIRE(bench.latency(leaf, a, b) == (leaf ? 7 : 8));
      }
    }
  });
}
