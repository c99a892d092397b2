// SPDX-License-Identifier: Apache-2.0
/// \file
/// Members of a module that return to their initial value at each configuration. The value at the start of simulation
/// is the initial one. Outside of a reconfigurable module they are plain variables, signals and FIFOs.
#ifndef CCHIP_RC_RESETTABLE_HPP
#define CCHIP_RC_RESETTABLE_HPP

#include <cchip/rc/context.hpp>
#include <systemc>
#include <utility>
#include <vector>

namespace cchip::rc {

/// A variable: `rc::var<int> n{"n", 5}; n += 2;` A value that must survive the module's absence is a plain C++
/// variable.
template <class T>
class var : public sc_core::sc_object, public resettable {
 public:
  explicit var(const char* name, T initial = T()) : sc_object(name), value_(initial), initial_(std::move(initial)) {}
  var& operator=(const T& value) {
    value_ = value;
    return *this;
  }
  operator T&() { return value_; }              // NOLINT(google-explicit-constructor): it is a T
  operator const T&() const { return value_; }  // NOLINT(google-explicit-constructor)
  T& get() { return value_; }
  const T& get() const { return value_; }
  const char* kind() const override { return "rc_var"; }

 private:
  void store_reset_value() override { initial_ = value_; }
  void reset() override { value_ = initial_; }

  T value_;
  T initial_;
};

/// sc_signal
template <class T, sc_core::sc_writer_policy Policy = sc_core::SC_ONE_WRITER>
class signal : public sc_core::sc_signal<T, Policy>, public resettable {
 public:
  using sc_core::sc_signal<T, Policy>::sc_signal;
  using sc_core::sc_signal<T, Policy>::operator=;

 private:
  void store_reset_value() override { initial_ = this->m_new_val; }
  void reset() override {  // not as a writer
    this->m_new_val = initial_;
    this->request_update();
  }

  T initial_{};
};

/// sc_fifo; neither data nor room while the module is not active
template <class T>
class fifo : public sc_core::sc_fifo<T>, public resettable {
 public:
  using sc_core::sc_fifo<T>::sc_fifo;
  int num_available() const override { return is_active() ? sc_core::sc_fifo<T>::num_available() : 0; }
  int num_free() const override { return is_active() ? sc_core::sc_fifo<T>::num_free() : 0; }

 private:
  bool is_active() const { return owner_ == nullptr || owner_->is_active(); }

  void store_reset_value() override {
    owner_ = context::of(this);
    const int count = this->m_size - this->m_free;
    for (int i = 0; i < count; ++i) initial_.push_back(this->m_buf[(this->m_ri + i) % this->m_size]);
  }
  void reset() override {
    for (T value; this->buf_read(value);) {
    }
    for (const T& value : initial_) this->buf_write(value);
    this->m_num_readable = static_cast<int>(initial_.size());
    this->m_num_read = this->m_num_written = 0;
  }
  void activated() override {
    if (num_available() > 0) this->m_data_written_event.notify(sc_core::SC_ZERO_TIME);
    if (num_free() > 0) this->m_data_read_event.notify(sc_core::SC_ZERO_TIME);
  }

  const context* owner_ = nullptr;
  std::vector<T> initial_;
};

}  // namespace cchip::rc

#endif
