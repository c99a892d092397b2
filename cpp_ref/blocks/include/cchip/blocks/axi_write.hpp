// SPDX-License-Identifier: Apache-2.0
/// \file
/// Clock-exact model of cchip_axi_write. A Moore machine, like those in stream.hpp.
#ifndef CCHIP_BLOCKS_AXI_WRITE_HPP
#define CCHIP_BLOCKS_AXI_WRITE_HPP

#include <cchip/blocks/line_data.hpp>
#include <cchip/internal/model/stream.hpp>
#include <cchip/internal/wire/definitions.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace cchip::model {

/// cchip_axi_write: writes of several clients, within a line each, into a memory that answers in order.
class AxiWrite {
 public:
  struct Beat {
    std::uint64_t address = 0;  ///< in beats; counts on the first beat of a write
    LineData data{};
    std::uint64_t strobes = 0;
    bool last = false;
  };
  struct Response {
    bool own = true;  ///< the ID is 0
    bool okay = true;
  };
  struct Inputs {
    std::uint32_t limit = 0;
    std::vector<std::optional<Beat>> beats;  ///< offered, one for each client
    bool awready = false;
    bool wready = false;
    std::optional<Response> response;  ///< bvalid = 1
  };
  struct Address {
    std::uint64_t address = 0;  ///< in beats
    std::size_t beats = 0;
  };
  struct Data {
    std::optional<LineData> data;  ///< without: the client of the write has been answered, nothing is written
    std::uint64_t strobes = 0;
    bool last = false;
  };
  struct Answer {
    std::size_t client = 0;
    WriteCode code = WriteCode::ok;
  };

  /// \param beats of a line
  AxiWrite(std::size_t clients, std::size_t beats, std::size_t outstanding)
      : clients_(clients), line_(beats), outstanding_(outstanding) {}

  /// Client whose beat is taken.
  const std::optional<std::size_t>& ready() const { return ready_; }
  const std::optional<Answer>& answer() const { return answer_; }
  bool awvalid() const { return addresses_.m_valid(); }
  const Address& address() const { return addresses_.m_data(); }
  bool wvalid() const { return data_.m_valid(); }
  const Data& data() const { return data_.m_data(); }
  bool bready() const { return bready_; }
  bool any_outstanding() const { return any_outstanding_; }

  void clock(const Inputs& in);
  void reset(std::uint32_t limit);

 private:
  static constexpr std::size_t queue_depth = 16;
  struct Write {
    std::size_t client = 0;
    Address address;
  };
  struct Take {
    std::size_t left;  // beats behind the present one
    bool refused;
    std::size_t client;
  };
  struct Waiting {
    std::size_t client;
    int ticks;  // seen, at most 2
  };

  /// What happens on this clock, decided from the state before it.
  struct Decisions {
    bool counts = false;    // a response, and there is a write whose address and data were taken
    bool answered = false;  // it is of the first write that is waited for
    bool timeout = false;   // that write is given up
    bool awaited = false;   // there is one
    bool pop = false;       // a beat leaves the queue
    bool send = false;      // a beat is sent
    bool refuse = false;    // the head of the queues is refused
    bool issue = false;     // it is sent
    bool refused = false;   // the last beat of a refused write leaves the queue
  };

  Decisions decide() const;
  void clock_answer(const Decisions& now);
  void clock_channels(const Decisions& now, const Inputs& in);
  void clock_head(const Decisions& now);
  void clock_waiting(const Decisions& now, std::uint32_t limit);
  void clock_responses(const Decisions& now, const Inputs& in);
  void clock_clients(const std::vector<std::optional<Beat>>& beats, const Decisions& now);
  void choose_turn(const std::vector<std::optional<Beat>>& beats, bool room);

  std::size_t clients_;
  std::size_t line_;
  std::size_t outstanding_;
  std::size_t served_ = clients_ - 1;
  std::optional<std::size_t> turn_, ready_;
  bool begun_ = false;
  Write current_;
  std::optional<Data> in_;
  std::size_t held_ = 0;  // beats taken that have not left their queue
  Fifo<Write> writes_{queue_depth};
  Fifo<Data> beats_{queue_depth};
  std::optional<Take> take_;           // whose beats leave the queue
  std::optional<std::size_t> send_;    // beats behind the one to send
  bool pops_ = false, sends_ = false;  // decided on the last clock: a beat leaves its queue, is sent
  SkidBuffer<Address> addresses_;
  SkidBuffer<Data> data_;
  std::deque<Waiting> waiting_;
  std::size_t dropped_ = 0;  // given up, the response is owed
  bool address_taken_ = false, burst_taken_ = false;
  std::size_t addresses_taken_ = 0, bursts_taken_ = 0;  // without a response
  std::optional<bool> response_;                        // okay
  bool bready_ = false;
  std::optional<Answer> answer_;
  Timeout timeout_{defs::memory_limit_default};
  bool any_outstanding_ = false;
};

}  // namespace cchip::model

#endif
