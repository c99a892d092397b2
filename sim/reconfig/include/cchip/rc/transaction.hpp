// SPDX-License-Identifier: Apache-2.0
/// \file
/// Transactions: while one is open, its module is not deactivated.
#ifndef CCHIP_RC_TRANSACTION_HPP
#define CCHIP_RC_TRANSACTION_HPP

#include <cchip/rc/context.hpp>
#include <string>
#include <systemc>

namespace cchip::rc {

/// One transaction of a module, open while this object lives:
///
///     { rc::transaction t(*this, "block of 64"); ...; }
///     possible_deactivation();
class transaction : public holder {
 public:
  transaction(context& module, std::string name) : module_(module), name_(std::move(name)) { module_.add(*this); }
  ~transaction() override {
    module_.remove(*this);
    module_.recheck();
  }
  transaction(const transaction&) = delete;
  transaction& operator=(const transaction&) = delete;
  std::string holding() const override { return "transaction " + name_; }

 private:
  context& module_;
  std::string name_;
};

/// Counts transactions begun minus those ended. While it is not 0, it holds the modules that it is add()ed to, or those
/// active at FIFO portals that count with it.
class transaction_counter : public holder {
 public:
  explicit transaction_counter(std::string name) : name_(std::move(name)) {}
  /// \param transactions may be negative, and so may the resulting count
  void add(long transactions) {
    count_ += transactions;
    if (count_ == 0) zero_.notify(sc_core::SC_ZERO_TIME);
  }
  long count() const { return count_; }
  std::string holding() const override {
    return count_ == 0 ? std::string() : name_ + ": " + std::to_string(count_) + " transaction(s)";
  }
  const sc_core::sc_event* let_go() const override { return &zero_; }

 private:
  std::string name_;
  long count_ = 0;
  sc_core::sc_event zero_;
};

}  // namespace cchip::rc

#endif
