// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cchip/blocks/axi_write.hpp>
#include <deque>
#include <map>
#include <models/cchip_axi_write.hpp>

#include "bench.hpp"

using namespace cchip;
using namespace cchip::test;

namespace {

using model::LineData;

/// How memory and clients behave; chances in per cent.
struct Behaviour {
  const char* name = "usual";
  int address = 60;   ///< awready on a clock
  int data = 70;      ///< wready on a clock
  int response = 60;  ///< a response on a clock
  int pause = 10;     ///< a client does not offer the next beat of its write
  int error = 0;      ///< of bresp
  int lost = 0;       ///< of a write: not answered before `silence` ends, or for long
  int unasked = 0;    ///< a response on a clock to no write, or with another ID
  /// periods in which nothing is taken or answered: they begin on a clock with 1 / 2^silence; 0: none
  int silence = 0;
  int limit = 100000;
  int changes = 0;  ///< the limit changes: up, down, to the default and to the highest
};
using B = Behaviour;
const std::vector<B> behaviours = {
    changed<B>("fast", {{&B::address, 100}, {&B::data, 100}, {&B::response, 100}, {&B::pause, 0}}),
    changed<B>("pauses", {{&B::address, 100}, {&B::data, 100}, {&B::response, 100}, {&B::pause, 50}}),
    B{},
    changed<B>("data first", {{&B::address, 10}, {&B::data, 90}}),
    changed<B>("address first", {{&B::address, 90}, {&B::data, 10}, {&B::pause, 0}}),
    changed<B>("slow", {{&B::address, 10}, {&B::data, 20}, {&B::response, 10}, {&B::pause, 0}}),
    changed<B>("errors", {{&B::address, 80}, {&B::data, 80}, {&B::response, 80}, {&B::error, 10}, {&B::unasked, 10}}),
    changed<B>("late",
               {{&B::data, 60}, {&B::pause, 5}, {&B::error, 2}, {&B::lost, 5}, {&B::unasked, 5}, {&B::limit, 150}}),
    changed<B>("silent", {{&B::data, 80},
                          {&B::response, 80},
                          {&B::pause, 5},
                          {&B::error, 1},
                          {&B::lost, 2},
                          {&B::unasked, 2},
                          {&B::silence, 8},
                          {&B::limit, 200}}),
    changed<B>("no time", {{&B::data, 80},
                           {&B::response, 80},
                           {&B::pause, 5},
                           {&B::error, 1},
                           {&B::lost, 2},
                           {&B::unasked, 2},
                           {&B::silence, 8},
                           {&B::limit, 3}}),
    changed<B>(
        "least",
        {{&B::address, 100}, {&B::data, 100}, {&B::response, 100}, {&B::pause, 0}, {&B::silence, 9}, {&B::limit, 1}}),
    changed<B>("changes", {{&B::data, 80},
                           {&B::response, 80},
                           {&B::pause, 5},
                           {&B::error, 1},
                           {&B::lost, 2},
                           {&B::unasked, 2},
                           {&B::silence, 8},
                           {&B::limit, 60},
                           {&B::changes, 1}}),
};

template <class Config>
class WriteBench {
 public:
  static constexpr std::size_t clients = Config::CLIENTS;
  static constexpr std::size_t beats = 512 / Config::DATA_W;
  static constexpr std::size_t words = Config::DATA_W / 32;
  static constexpr std::size_t bytes = Config::DATA_W / 8;
  static constexpr int address_w = 64 - (Config::DATA_W == 64    ? 3
                                         : Config::DATA_W == 128 ? 4
                                         : Config::DATA_W == 256 ? 5
                                                                 : 6);

  WriteBench(sim::Simulation<typename Config::Model>& simulation, Random& random)
      : simulation_(simulation), top_(simulation.top()), random_(random), model_(clients, beats, Config::OUTSTANDING) {}

  /// \param percent a client begins a write on a clock
  /// \param most beats of a write
  void run(const Behaviour& how, int percent, int clocks, std::size_t most = beats) {
    most_ = most;
    for (const bool whole : {false, true}) {  // reset also with writes in flight
      reset(how);
      for (int clock = 0; clock < (whole ? clocks : clocks / 8); ++clock) step(percent);
    }
    lost_.clear();
    how_.silence = how_.lost = how_.unasked = 0;
    how_.changes = false;
    top_.limit = how.limit;
    silent_ = 0;
    how_.address = how_.data = how_.response = 60;
    for (int clock = 0; clock < 40000 && (open() != 0 || model_.any_outstanding()); ++clock) step(0);
    REQUIRE(open() == 0);
    for (int clock = 0; clock < 8; ++clock) step(0);
    REQUIRE(top_.any_outstanding == 0);
    REQUIRE(top_.m_axi_awvalid == 0);
    REQUIRE(top_.m_axi_wvalid == 0);
    REQUIRE(addresses_.empty());
    REQUIRE(bursts_.empty());
    for (const auto& [line, write] : writes_) check(line, write);
  }

  std::array<std::uint64_t, 4> answers{};  ///< of each code
  std::uint64_t beats_taken = 0;           ///< by memory
  std::uint64_t blank = 0;                 ///< beats without strobes
  std::uint64_t most_open = 0;             ///< bursts not answered

 private:
  struct Byte {
    std::uint8_t value = 0;
    bool written = false;
  };
  using Bytes = std::array<Byte, 64>;
  struct Written {
    std::size_t client = 0;
    Bytes bytes{};  // that the client wants written
    std::optional<WriteCode> answer;
    std::uint64_t ordinal = 0;
  };
  struct Client {
    std::deque<model::AxiWrite::Beat> beats;  // that it has to offer
    bool begun = false;                       // and has offered one of them
    bool offered = false;
    std::deque<std::uint64_t> waiting;  // lines of the writes that are not answered
    std::optional<std::uint64_t> sent;  // ordinal of its write that memory saw last
  };
  using Burst = std::vector<model::AxiWrite::Data>;

  std::size_t open() const {
    std::size_t count = 0;
    for (const Client& client : clients_) count += client.waiting.size() + client.beats.size();
    return count;
  }

  void reset(const Behaviour& how) {
    how_ = how;
    top_.limit = how.limit;
    top_.s_valid = 0;
    top_.m_axi_awready = 0;
    top_.m_axi_wready = 0;
    top_.m_axi_bvalid = 0;
    simulation_.reset();
    model_.reset(how.limit);
    clients_.assign(clients, Client{});
    writes_.clear();
    memory_.clear();
    addresses_.clear();
    bursts_.clear();
    lost_.clear();
    burst_ = Burst{};
    silent_ = 0;
  }

  void step(int percent) {
    model::AxiWrite::Inputs in;
    if (how_.changes && chance(random_, 2)) top_.limit = any_limit(random_, how_.limit);
    in.limit = top_.limit;
    if (silent_ > 0) {
      --silent_;
      if (silent_ == 0) lost_.clear();
    } else if (how_.silence != 0 && random_() % (std::uint64_t{1} << how_.silence) == 0) {
      silent_ = 1 + static_cast<int>(random_() % 1000);
    }

    in.beats.resize(clients);
    for (std::size_t c = 0; c < clients; ++c) offer(c, percent, in.beats[c]);
    in.awready = silent_ == 0 && chance(random_, how_.address);
    in.wready = silent_ == 0 && chance(random_, how_.data);
    in.response = respond();
    top_.m_axi_awready = in.awready;
    top_.m_axi_wready = in.wready;
    top_.m_axi_bvalid = in.response ? 1 : 0;
    sim::set_bits(top_.m_axi_bid, 0, Config::ID_W, random_());
    sim::set_bits(top_.m_axi_bresp, 0, 2, random_());
    if (in.response) {
      const std::uint64_t other = 1 + random_() % ((std::uint64_t{1} << Config::ID_W) - 1);
      sim::set_bits(top_.m_axi_bid, 0, Config::ID_W, in.response->own ? 0 : other);
      sim::set_bits(top_.m_axi_bresp, 0, 2, in.response->okay ? 0 : 1 + random_() % 3);
    }
    simulation_.settle();
    compare();
    if (model_.ready() && in.beats[*model_.ready()]) take_beat(*model_.ready());
    if (model_.answer()) take_answer(*model_.answer());
    if (model_.awvalid() && in.awready) take_address();
    if (model_.wvalid() && in.wready) take_data();
    most_open = std::max<std::uint64_t>(most_open, std::min(addresses_.size(), bursts_.size()));
    model_.clock(in);
    simulation_.rise();
  }

  // ---- clients
  void offer(std::size_t c, int percent, std::optional<model::AxiWrite::Beat>& beat) {
    Client& client = clients_[c];
    if (client.beats.empty() && chance(random_, percent)) begin_write(c);
    const bool waits = client.begun && chance(random_, how_.pause);
    if (!client.beats.empty() && (client.offered || !waits)) {
      beat = client.beats.front();
      client.offered = true;
    }
    model::AxiWrite::Beat shown;  // anything, where nothing is looked at
    shown.address = random_();
    for (std::uint32_t& word : shown.data) word = static_cast<std::uint32_t>(random_());
    shown.strobes = random_();
    shown.last = chance(random_, 50);
    if (beat) {
      if (client.begun) beat->address = shown.address;
      shown = *beat;
    }
    const int at = static_cast<int>(c);
    sim::set_bits(top_.s_valid, at, 1, beat ? 1 : 0);
    sim::set_bits(top_.s_last, at, 1, shown.last);
    sim::set_bits(top_.s_address, address_w * at, address_w, shown.address);
    for (std::size_t w = 0; w < words; ++w)
      sim::set_bits(top_.s_data, Config::DATA_W * at + static_cast<int>(32 * w), 32, shown.data[w]);
    sim::set_bits(top_.s_strb, static_cast<int>(bytes) * at, static_cast<int>(bytes), shown.strobes);
  }

  void begin_write(std::size_t c) {
    // a line of its own, so that what memory holds tells outcome of this write
    std::uint64_t line = 0;
    do {
      line = random_() >> 6;
    } while (writes_.count(line) != 0);
    Written write;
    write.client = c;
    write.ordinal = ++ordinal_;
    const std::size_t first = random_() % beats;
    const std::size_t count = 1 + random_() % std::min(most_, beats - first);
    for (std::size_t i = 0; i < count; ++i) {
      model::AxiWrite::Beat beat;
      beat.address = line * beats + first;
      for (std::size_t w = 0; w < words; ++w) beat.data[w] = static_cast<std::uint32_t>(random_());
      beat.strobes = random_() % 2 == 0 ? ~std::uint64_t{0} : random_();
      if (bytes < 64) beat.strobes &= (std::uint64_t{1} << bytes) - 1;
      // at the end of the line the write ends by itself
      beat.last = i + 1 == count && (first + count != beats || chance(random_, 50));
      write_bytes(write.bytes, first + i, beat.data, beat.strobes);
      clients_[c].beats.push_back(beat);
    }
    writes_[line] = write;
    clients_[c].waiting.push_back(line);
  }

  void take_beat(std::size_t c) {
    Client& client = clients_[c];
    client.beats.pop_front();
    client.begun = !client.beats.empty();
    client.offered = false;
  }

  void take_answer(const model::AxiWrite::Answer& answer) {
    Client& client = clients_[answer.client];
    REQUIRE(!client.waiting.empty());
    const std::uint64_t line = client.waiting.front();
    client.waiting.pop_front();
    REQUIRE((!client.waiting.empty() || client.beats.empty()));
    writes_[line].answer = answer.code;
    check(line, writes_[line]);
    ++answers[static_cast<std::size_t>(answer.code)];
  }

  /// Independent of the model: what memory holds of a write.
  void check(std::uint64_t line, const Written& write) {
    REQUIRE(write.answer.has_value());
    const auto found = memory_.find(line);
    const Bytes held = found == memory_.end() ? Bytes{} : found->second;
    const WriteCode code = *write.answer;
    for (std::size_t i = 0; i < 64; ++i) {
      const Byte& byte = held[i];
      if (byte.written) REQUIRE((write.bytes[i].written && byte.value == write.bytes[i].value));
      if (code == WriteCode::ok) REQUIRE(byte.written == write.bytes[i].written);
      if (code == WriteCode::owed) REQUIRE(!byte.written);
    }
  }

  static void write_bytes(Bytes& into, std::size_t beat, const LineData& data, std::uint64_t strobes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      if ((strobes >> i & 1) == 0) continue;
      into[bytes * beat + i] = Byte{static_cast<std::uint8_t>(data[i / 4] >> (8 * (i % 4))), true};
    }
  }

  // ---- memory
  void take_address() {
    const auto& address = model_.address();
    REQUIRE(address.address % beats + address.beats <= beats);
    const auto write = writes_.find(address.address / beats);
    REQUIRE(write != writes_.end());
    Client& client = clients_[write->second.client];
    REQUIRE((!client.sent || *client.sent < write->second.ordinal));
    client.sent = write->second.ordinal;
    addresses_.push_back(address);
    if (chance(random_, how_.lost)) lost_.push_back(address.address);
  }

  void take_data() {
    ++beats_taken;
    if (!model_.data().data) ++blank;
    burst_.push_back(model_.data());
    if (!model_.data().last) return;
    bursts_.push_back(burst_);
    burst_ = Burst{};
  }

  std::optional<model::AxiWrite::Response> respond() {
    if (addresses_.empty() || bursts_.empty()) {
      if (chance(random_, how_.unasked)) return model::AxiWrite::Response{chance(random_, 50), chance(random_, 50)};
      return std::nullopt;
    }
    if (chance(random_, how_.unasked)) return model::AxiWrite::Response{false, chance(random_, 50)};
    if (silent_ != 0 || !chance(random_, how_.response)) return std::nullopt;
    const model::AxiWrite::Address address = addresses_.front();
    if (std::find(lost_.begin(), lost_.end(), address.address) != lost_.end()) {
      if (chance(random_, 1)) lost_.clear();
      return std::nullopt;
    }
    const Burst burst = bursts_.front();
    addresses_.pop_front();
    bursts_.pop_front();
    REQUIRE(burst.size() == address.beats);
    const bool okay = !chance(random_, how_.error);
    if (okay || chance(random_, 50)) {
      for (std::size_t i = 0; i < burst.size(); ++i) {
        const auto& data = burst[i];
        if (data.data)
          write_bytes(memory_[address.address / beats], address.address % beats + i, *data.data, data.strobes);
      }
    }
    return model::AxiWrite::Response{true, okay};
  }

  void compare() {
    REQUIRE(top_.s_ready == (model_.ready() ? 1U << *model_.ready() : 0U));
    const auto& answer = model_.answer();
    REQUIRE(top_.m_valid == (answer ? 1U << answer->client : 0U));
    if (answer) REQUIRE(top_.m_code == static_cast<unsigned>(answer->code));
    REQUIRE((top_.m_axi_awvalid != 0) == model_.awvalid());
    if (model_.awvalid()) {
      REQUIRE(top_.m_axi_awaddr == model_.address().address * bytes);
      REQUIRE(std::size_t{top_.m_axi_awlen} + 1 == model_.address().beats);
    }
    REQUIRE(top_.m_axi_awid == 0);
    REQUIRE((top_.m_axi_wvalid != 0) == model_.wvalid());
    if (model_.wvalid()) {
      const auto& data = model_.data();
      REQUIRE((top_.m_axi_wlast != 0) == data.last);
      REQUIRE(sim::get_bits(top_.m_axi_wstrb, 0, static_cast<int>(bytes)) == data.strobes);
      for (std::size_t w = 0; data.data && w < words; ++w)
        REQUIRE(sim::get_bits(top_.m_axi_wdata, static_cast<int>(32 * w), 32) == (*data.data)[w]);
    }
    REQUIRE((top_.m_axi_bready != 0) == model_.bready());
    REQUIRE((top_.any_outstanding != 0) == model_.any_outstanding());
  }

  sim::Simulation<typename Config::Model>& simulation_;
  typename Config::Model& top_;
  Random& random_;
  model::AxiWrite model_;
  Behaviour how_{};
  std::size_t most_ = beats;
  int silent_ = 0;
  std::uint64_t ordinal_ = 0;
  std::vector<Client> clients_;
  std::map<std::uint64_t, Written> writes_;  // by line
  std::map<std::uint64_t, Bytes> memory_;
  std::deque<model::AxiWrite::Address> addresses_;  // taken, not answered
  std::deque<Burst> bursts_;
  Burst burst_;
  std::vector<std::uint64_t> lost_;  // addresses of writes that are not answered for now
};

}  // namespace

TEMPLATE_LIST_TEST_CASE(
    "cchip_axi_write: outputs are the model's on every clock, every write is answered, and memory holds what its "
    "answer "
    "says",
    "[unit][cchip_axi_write]", cchip_axi_write_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    for (const Behaviour& how : behaviours) {
      for (const int percent : {100, 20}) {
        CAPTURE(how.name, percent);
        WriteBench<TestType> bench(simulation, random);
        bench.run(how, percent, 6000);
        const auto count = [&](WriteCode code) { return bench.answers[static_cast<std::size_t>(code)]; };
        const bool times_out = how.limit < 100000;
        if (how.limit > 100) REQUIRE(count(WriteCode::ok) > 50);
        const bool faulty = how.error != 0;
        if (!faulty || !times_out) REQUIRE((count(WriteCode::bus) != 0) == faulty);
        REQUIRE((count(WriteCode::timeout) != 0) == times_out);
        REQUIRE((count(WriteCode::owed) != 0) == times_out);
        if (!times_out) REQUIRE(bench.blank == 0);
        REQUIRE(bench.most_open <= TestType::OUTSTANDING);
      }
    }
  });
}

TEMPLATE_LIST_TEST_CASE("cchip_axi_write: a beat on every second clock, a silent bus ends in time-outs",
                        "[unit][cchip_axi_write]", cchip_axi_write_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random& random) {
    auto& top = simulation.top();
    for (const bool taken : {false, true}) {
      constexpr int limit = 40;
      constexpr int writes = 30;
      top.limit = limit;
      top.s_valid = 0;
      top.m_axi_bvalid = 0;
      top.m_axi_awready = taken;
      top.m_axi_wready = taken;
      sim::set_random(top.s_data, TestType::DATA_W * TestType::CLIENTS, random);
      simulation.reset();
      int offered = 0;  // clock of the first address
      int first = 0;
      int left = writes;
      int timeouts = 0;
      int refused = 0;
      top.s_last = (1 << TestType::CLIENTS) - 1;
      for (int clock = 0; clock < 2 * (2 * limit + TestType::OUTSTANDING + 8) + 4 * writes; ++clock) {
        top.s_valid = left != 0 ? 1 : 0;
        simulation.settle();
        if (top.s_valid != 0 && (top.s_ready & 1) != 0) --left;
        if (offered == 0 && top.m_axi_awvalid != 0) offered = clock;
        if (top.m_valid != 0) {
          REQUIRE(top.m_valid == 1);
          if (first == 0) first = clock;
          timeouts += top.m_code == static_cast<unsigned>(WriteCode::timeout) ? 1 : 0;
          refused += top.m_code == static_cast<unsigned>(WriteCode::owed) ? 1 : 0;
        }
        simulation.rise();
      }
      REQUIRE(first > offered + limit);
      REQUIRE(first <= offered + 2 * limit + TestType::OUTSTANDING + 8);
      REQUIRE(timeouts + refused == writes);
      REQUIRE(timeouts >= 1);
      if (taken) REQUIRE(timeouts == std::min<int>(TestType::OUTSTANDING, writes));
      if (!taken) REQUIRE(timeouts <= 4);
      REQUIRE(top.any_outstanding == 1);
    }

    // as fast as it can
    for (const std::size_t most : {std::size_t{1}, std::size_t{8}}) {
      WriteBench<TestType> bench(simulation, random);
      bench.run(behaviours[0], 100, 2000, most);
      INFO(bench.beats_taken << " beats in 2250 clocks");
      if (TestType::OUTSTANDING >= 16) REQUIRE(bench.beats_taken > 1100);
    }
  });
}

namespace {

/// Clock on which the answer to a write comes that memory takes and never answers; 0: none in `clocks`. The limit
/// changes on clock `when`; the write is offered from clock 0 on.
template <class Config, class Simulation>
int clock_of_timeout(Simulation& simulation, std::uint32_t before, std::uint32_t after, int when, int clocks) {
  auto& top = simulation.top();
  top.limit = before;
  top.s_valid = 0;
  top.s_last = (1 << Config::CLIENTS) - 1;
  top.m_axi_awready = 1;
  top.m_axi_wready = 1;
  top.m_axi_bvalid = 0;
  simulation.reset();
  if (when < 0) top.limit = after;
  simulation.steps(20);
  bool offered = true;
  for (int clock = 0; clock < clocks; ++clock) {
    top.s_valid = offered ? 1 : 0;
    if (clock == when) top.limit = after;
    simulation.settle();
    if (top.m_valid != 0) {
      REQUIRE(top.m_code == static_cast<unsigned>(WriteCode::timeout));
      return clock;
    }
    if ((top.s_ready & 1) != 0) offered = false;
    simulation.rise();
  }
  return 0;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("cchip_axi_write: a limit counts from the clock on which it changes, 0 is the default",
                        "[unit][cchip_axi_write]", cchip_axi_write_configs) {
  for_two_power_ups<typename TestType::Model>([](auto& simulation, Random&) {
    constexpr int more = TestType::OUTSTANDING + 10;
    const auto clock_of = [&](std::uint32_t before, std::uint32_t after, int when, int clocks) {
      return clock_of_timeout<TestType>(simulation, before, after, when, clocks);
    };
    constexpr int turn = 5;  // clocks until the write's turn, when it begins to last
    for (const int limit : {1, 2, 100}) {
      const auto bound = static_cast<std::uint32_t>(limit);
      for (const std::uint32_t high : {20000U, 0U, ~0U}) {
        CAPTURE(limit, high);
        for (const int when : {-1, 3, 50, 130, 700}) {  // lowered, before and during the write
          CAPTURE(when);
          const int clock = clock_of(high, bound, when, 20000);
          REQUIRE(clock > limit);
          REQUIRE(clock >= when);
          REQUIRE(clock <= std::max(when, turn) + 2 * limit + more);
        }
        if (limit < 100) continue;
        for (int when = 0; when < limit; when += 7) REQUIRE(clock_of(bound, high, when, 3000) == 0);  // raised
      }
    }
    constexpr int standard = defs::memory_limit_default;
    for (const int when : {-1, 60}) {
      const int clock = clock_of(100, 0, when, 10000);
      REQUIRE(clock > standard);
      REQUIRE(clock <= std::max(when, turn) + 2 * standard + more);
    }
  });
}
