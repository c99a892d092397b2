// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_get_data. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_GET_DATA_HPP
#define CCHIP_BLOCKS_GET_DATA_HPP

#include <algorithm>
#include <array>
#include <cchip/blocks/line_data.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cchip::model {

/// cchip_get_data: the two lines of a pair, from the cache to who tests it. Of the pairs of arrays the first is A.
class GetData {
 public:
  /// How a query ends if a line is not what it should be; 0: it is.
  enum class End { ok = 0, corrupt = 4, outside = 5, bad_descriptor = 6, memory = 7 };

  struct Request {
    std::size_t place = 0;  ///< from the number of node pairs on: leaves
    std::size_t context = 0;
    std::uint64_t record = 0;  ///< m_record of cchip_traversal
    std::array<std::uint32_t, 2> lines{};
  };
  struct Line {
    std::size_t place = 0;
    ReadCode code = ReadCode::ok;
    LineData data{};
  };
  struct Inputs {
    std::optional<Request> request;
    std::optional<std::size_t> pose;  ///< of this context
    std::array<std::optional<Line>, 2> lines;
    bool pair_ready = false;
    bool leaf_taken = false;            ///< the receiver of leaves has room for one more
    std::optional<std::size_t> lookup;  ///< of this place
  };
  struct Ask {
    std::size_t place = 0;
    std::array<std::uint32_t, 2> lines{};
  };
  struct Pair {
    std::size_t place = 0;
    std::size_t context = 0;
    std::uint64_t record = 0;
    std::array<Line, 2> lines;
    bool failed() const { return lines[0].code != ReadCode::ok || lines[1].code != ReadCode::ok; }
  };
  struct Node {
    std::uint32_t first = 0;             ///< of a header: the root
    std::optional<std::uint32_t> kinds;  ///< of the children; none of a header
  };
  struct Nodes {
    End end = End::ok;
    std::array<Node, 2> nodes;
  };
  /// What a lookup shows; without value: nothing that is defined.
  struct Known {
    std::optional<Request> request;
    std::optional<Nodes> nodes;
  };

  /// \param leaf_room leaf pairs that their receiver has room for
  GetData(std::size_t contexts, std::size_t pairs, std::size_t leaves, int leaf_room = 1)
      : pairs_(pairs), places_(pairs + leaves), leaf_room_(leaf_room), room_left_(leaf_room) {
    const std::size_t places = pairs + leaves;
    for (Port& port : ports_) port = Port(pairs, leaves);
    requests_.resize(places);
    nodes_.resize(places);
    no_pose_.resize(contexts);
    sizes_.resize(contexts);
  }

  const std::optional<Ask>& ask() const { return ask_; }
  bool pair_valid() const { return pair_valid_; }
  /// Defined while pair_valid().
  const Pair& pair() const { return pair_; }
  /// The first of eight beats of a leaf pair.
  bool leaf_valid() const { return leaf_age_ == 1; }
  /// Defined with leaf_valid() and the seven clocks after it.
  const Pair& leaf() const { return leaf_; }
  bool leaf_left() const { return leaf_left_ == 1; }
  const Known& known() const { return known_; }

  void clock(const Inputs& in) {
    const bool go = fetch_ && fetch_->age == 2 && !held_ && (!pair_valid_ || in.pair_ready);
    const auto waits = [&](Kind kind, std::size_t p) { return ports_[p].whole[kind].m_valid(); };
    const std::array<bool, 2> may{!fetch_ || go, beats_left_ <= 1};
    const bool leaf_goes = beats_left_ == 8 && (room_left_ > 0 || in.leaf_taken);
    std::array<std::optional<std::size_t>, 2> pick;  // of each kind: from this port
    for (const Kind kind : {nodes_of, leaves_of}) {
      if (may[kind] && (waits(kind, 0) || waits(kind, 1)))
        pick[kind] = waits(kind, 1) && (turn_[kind] == 1 || !waits(kind, 0)) ? 1 : 0;
    }
    const bool held = fetch_ && is_header(*requests_[fetch_->place]) && no_pose_[requests_[fetch_->place]->context];

    if (in.lookup) known_ = Known{requests_[*in.lookup], nodes_[*in.lookup]};

    // what the lines of a node pair say, one, two and three clocks after it is offered
    if (checks_[1] && checks_[1]->header) sizes_[checks_[1]->context] = checks_[1]->sizes;
    if (checks_[2]) nodes_[checks_[2]->place] = checks_[2]->nodes;
    checks_[2] = checks_[1];
    checks_[1] = checks_[0];
    checks_[0] = fresh_ ? check(pair_) : std::nullopt;

    // a node pair leaves
    fresh_ = go;
    pair_valid_ = go || (pair_valid_ && !in.pair_ready);
    if (go) {
      pair_ = pair_of(fetch_->place);
      fetch_.reset();
    }
    if (fetch_) fetch_->age = std::min(fetch_->age + 1, 2);
    if (pick[nodes_of]) fetch_ = Fetch{ports_[*pick[nodes_of]].whole[nodes_of].m_data(), 0};
    held_ = held;

    // a leaf pair leaves: its first beat waits for room, and takes two clocks
    leaf_left_ = std::max(leaf_left_ - 1, 0);
    if (beats_left_ == 1) leaf_left_ = 2;
    if (beats_left_ < 8 || leaf_goes) beats_left_ = std::max(beats_left_ - 1, 0);
    leaf_age_ = leaf_goes ? 0 : std::min(leaf_age_ + 1, 2);
    if (leaf_age_ == 1) leaf_ = pair_of(leaf_fetch_);
    if (pick[leaves_of]) {
      leaf_fetch_ = ports_[*pick[leaves_of]].whole[leaves_of].m_data();
      beats_left_ = 8;
    }
    room_left_ += (in.leaf_taken ? 1 : 0) - (leaf_goes ? 1 : 0);
    for (const Kind kind : {nodes_of, leaves_of}) {
      if (pick[kind]) turn_[kind] = 1 - *pick[kind];
    }

    // lines come: the port of the second one has the pair, found a clock later
    std::array<std::optional<std::size_t>, 2> second;
    for (std::size_t p = 0; p < 2; ++p) {
      if (!came_[p]) continue;
      const std::size_t place = *came_[p];
      const bool together = came_[1 - p] == place;
      if (together ? p == 0 : ports_[1 - p].came[place]) second[p] = place;
    }
    for (std::size_t p = 0; p < 2; ++p) {
      Port& port = ports_[p];
      for (const Kind k : {nodes_of, leaves_of}) {
        const bool push = port.second && (*port.second >= pairs_) == (k == leaves_of);
        port.whole[k].clock(push, port.second.value_or(0), pick[k] == p);
      }
      port.second = second[p];
      if (came_[p]) port.came[*came_[p]] = true;
      came_[p].reset();
      if (!in.lines[p]) continue;
      port.lines[in.lines[p]->place] = in.lines[p];
      came_[p] = in.lines[p]->place;
    }
    for (const auto& place : second) {
      if (place) ports_[0].came[*place] = ports_[1].came[*place] = false;
    }

    // requests
    ask_.reset();
    if (in.pose) no_pose_[*in.pose] = false;
    if (in.request) {
      requests_[in.request->place] = in.request;
      ask_ = Ask{in.request->place, in.request->lines};
      if (is_header(*in.request)) no_pose_[in.request->context] = true;
    }
  }

  /// One clock with rst = 1. What was known of places and images is undefined.
  void reset() { *this = GetData(no_pose_.size(), pairs_, places_ - pairs_, leaf_room_); }

 private:
  enum Kind { nodes_of, leaves_of };
  struct Port {
    Port(std::size_t pairs, std::size_t leaves)
        : lines(pairs + leaves), came(pairs + leaves), whole{Fifo<std::size_t>(pairs), Fifo<std::size_t>(leaves)} {}
    std::vector<std::optional<Line>> lines;  // by place
    std::vector<bool> came;                  // and the other port's has not
    std::optional<std::size_t> second;       // came on the last clock
    std::array<Fifo<std::size_t>, 2> whole;  // by kind
  };
  struct Fetch {
    std::size_t place;
    int age;  // clocks since it was picked, at most 2
  };
  using Sizes = std::array<std::uint32_t, 2>;
  struct Check {
    std::size_t place, context;
    bool header;
    Sizes sizes;
    std::optional<Nodes> nodes;
  };

  static bool is_header(const Request& request) { return (request.record >> 58 & 1) != 0; }
  static std::uint32_t field(const LineData& data, std::size_t lsb, std::size_t width) {
    std::uint32_t value = 0;
    for (std::size_t bit = 0; bit < width; ++bit) {
      value |= (data[(lsb + bit) / 32] >> ((lsb + bit) % 32) & 1) << bit;
    }
    return value;
  }

  /// A child of a node has a box with greatest < least on an axis.
  static bool inverted(const LineData& data) {
    for (std::size_t child = 0; child < 4; ++child) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = 96 + 102 * child + 14 * axis;
        const auto offset = [&data](std::size_t lsb) { return field(data, lsb, 7) ^ 64; };  // keeps the order of signed
        if (offset(at + 7) < offset(at)) return true;
      }
    }
    return false;
  }

  Pair pair_of(std::size_t place) const {
    const Request& request = *requests_[place];
    return {request.place, request.context, request.record, {*ports_[0].lines[place], *ports_[1].lines[place]}};
  }

  std::optional<Check> check(const Pair& pair) const {
    Check check{pair.place, pair.context, (pair.record >> 58 & 1) != 0, {}, {}};
    const auto& sizes = sizes_[pair.context];
    if (!check.header && !sizes) return check;  // of a query without header: undefined
    Nodes nodes;
    std::array<End, 2> ends{};
    bool no_header = false;
    for (std::size_t p = 0; p < 2; ++p) {
      const LineData& data = pair.lines[p].data;
      const bool failed = pair.lines[p].code != ReadCode::ok;
      Node& node = nodes.nodes[p];
      check.sizes[p] = std::min<std::uint32_t>(field(data, 96, 32), 1U << 24);
      bool outside = false;
      if (check.header) {
        node = Node{field(data, 128, 24), std::nullopt};
        outside = node.first >= check.sizes[p];
        no_header = no_header || (!failed && (field(data, 0, 32) != 0x4D494343 || field(data, 64, 16) != 1));
      } else {
        node = Node{field(data, 59, 24), field(data, 83, 8)};
        const std::uint32_t at = pair.record >> (28 * p) & 0xffffff;
        outside = node.first <= at || node.first + field(data, 91, 2) >= (*sizes)[p];
      }
      const bool corrupt = !check.header && (field(data, 54, 5) > 18 || inverted(data));
      ends[p] = failed ? End::memory : corrupt ? End::corrupt : outside ? End::outside : End::ok;
    }
    nodes.end = ends[0] == End::memory ? End::memory
                : no_header            ? End::bad_descriptor
                : ends[0] != End::ok   ? ends[0]
                                       : ends[1];
    check.nodes = nodes;
    return check;
  }

  std::size_t pairs_, places_;
  int leaf_room_, room_left_;
  std::array<Port, 2> ports_{Port(1, 1), Port(1, 1)};
  std::array<std::optional<std::size_t>, 2> came_;  // places of the lines of the last clock
  std::vector<std::optional<Request>> requests_;    // by place
  std::vector<std::optional<Nodes>> nodes_;         // by place
  std::vector<bool> no_pose_;                       // by context
  std::vector<std::optional<Sizes>> sizes_;         // by context
  std::optional<Ask> ask_;
  std::optional<Fetch> fetch_;
  bool held_ = false;                  // the pair that is fetched waited for its pose a clock ago
  std::array<std::size_t, 2> turn_{};  // by kind
  bool pair_valid_ = false, fresh_ = false;
  Pair pair_, leaf_;
  std::size_t leaf_fetch_ = 0;  // place of the leaf pair whose beats are read
  int leaf_age_ = 2;            // clocks since it went, at most 2
  int beats_left_ = 0;          // of it, to be read
  int leaf_left_ = 0;           // clocks to its last one, 1 on that clock
  std::array<std::optional<Check>, 3> checks_;
  Known known_;
};

}  // namespace cchip::model

#endif
