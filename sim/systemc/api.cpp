// SPDX-License-Identifier: Apache-2.0
#include <cchip/levels/api.hpp>
#include <exception>
#include <stdexcept>

namespace cchip::levels {

Api::Api(const sc_core::sc_module_name& name, const Stimulus& stimulus, sc_core::sc_time patience)
    : sc_module(name), stimulus_(stimulus), patience_(patience), answers_(stimulus.size(), unanswered) {
  SC_HAS_PROCESS(Api);
  SC_THREAD(run_sender);
  SC_THREAD(run_receiver);
  SC_THREAD(watch);
}

void Api::fail(const std::string& message) {
  if (failure_.empty()) failure_ = message + " (at " + sc_core::sc_time_stamp().to_string() + ")";
  sc_core::sc_stop();
}

void Api::guarded(void (Api::*body)()) {
  try {
    (this->*body)();
  } catch (const sc_core::sc_unwind_exception&) {
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Api::send_all() {
  for (const ObjectPair& objects : object_pairs(stimulus_)) {
    prepare(objects);
    ++prepared_;
    const std::size_t end = objects.first + objects.count;
    for (std::size_t i = objects.first; i < end; ++i) send(i);
    while (answered_ < end) wait(answer_);
  }
  sc_core::sc_stop();
}

void Api::receive_all() {
  while (true) {
    const auto [index, hit] = receive();
    if (answers_.at(index) != unanswered) {
      throw std::runtime_error("primitive pair " + std::to_string(index) + " is answered twice");
    }
    answers_[index] = hit ? 1 : 0;
    progress_.update_of(++answered_, stimulus_.size());
    answer_.notify();
  }
}

void Api::watch() {
  while (true) {
    const std::size_t before = answered_ + prepared_;
    wait(patience_);
    if (answered_ + prepared_ != before) continue;
    fail("nothing happens for " + patience_.to_string() + ": " + std::to_string(answered_) + " of " +
         std::to_string(stimulus_.size()) + " primitive pairs are answered, " + std::to_string(prepared_) +
         " object pairs were begun");
  }
}

}  // namespace cchip::levels
