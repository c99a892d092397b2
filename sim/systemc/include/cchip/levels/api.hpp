// SPDX-License-Identifier: Apache-2.0
/// \file
/// The process called API in the paper: it knows the kinds of the objects and sends their primitive pairs.
#ifndef CCHIP_LEVELS_API_HPP
#define CCHIP_LEVELS_API_HPP

#include <cchip/levels/stimulus.hpp>
#include <cchip/program/progress.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

namespace cchip::levels {

/// Sends one object pair after the other and stops the simulation after the last. Two processes, so that any FIFO is
/// long enough: one sends, one receives. A third ends the simulation with an error if nothing happens for a while.
class Api : public sc_core::sc_module {
 public:
  /// Marks an answer that did not come.
  static constexpr std::uint8_t unanswered = 2;

  /// \param patience longest time without an answer or a prepared object pair
  Api(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience);

  /// In the order of the stimulus: 0 apart, 1 intersecting, `unanswered`.
  const std::vector<std::uint8_t>& answers() const { return answers_; }
  /// What went wrong, empty if nothing.
  const std::string& failure() const { return failure_; }

 protected:
  const Stimulus& stimulus() const { return stimulus_; }
  /// Index of the first primitive pair that is not answered yet, if answers come in order.
  std::size_t answered() const { return answered_; }
  /// Records what went wrong and ends the simulation.
  void fail(const std::string& message);

  /// Called before the first primitive pair of an object pair is sent, when all those before it are answered. May wait.
  virtual void prepare(const ObjectPair&) {}
  /// Sends the primitive pair with this index; may wait.
  virtual void send(std::size_t index) = 0;
  /// Waits for the next answer: index of the primitive pair, hit.
  virtual std::pair<std::size_t, bool> receive() = 0;

 private:
  void send_all();
  void receive_all();
  void watch();
  void guarded(void (Api::*body)());
  void run_sender() { guarded(&Api::send_all); }
  void run_receiver() { guarded(&Api::receive_all); }

  const Stimulus& stimulus_;
  sc_core::sc_time patience_;
  std::vector<std::uint8_t> answers_;
  std::string failure_;
  Progress progress_;
  std::size_t answered_ = 0;
  std::size_t prepared_ = 0;
  sc_core::sc_event answer_;
};

}  // namespace cchip::levels

#endif
