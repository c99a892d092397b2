// SPDX-License-Identifier: Apache-2.0
#include "system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cchip/rc/rc.hpp>
#include <cchip/rc/timed_control.hpp>
#include <memory>
#include <stdexcept>

namespace cchip::table1 {
namespace {

using sc_core::sc_time;

/// Represents a primitive test: takes the work of an object pair, works, answers. Knows nothing of reconfiguration.
class TimedTest : public sc_core::sc_module {
 public:
  sc_core::sc_fifo_in<sc_time> work{"work"};
  sc_core::sc_fifo_out<bool> answer{"answer"};

  SC_HAS_PROCESS(TimedTest);
  explicit TimedTest(const sc_core::sc_module_name& name) : sc_module(name) { SC_THREAD(test); }

 private:
  void test() {
    for (;;) {
      wait(work.read());
      answer.write(true);
    }
  }
};

/// The host's end of one test or slot.
struct Channels {
  sc_core::sc_fifo<sc_time> work{1};
  sc_core::sc_fifo<bool> answer{1};
};

/// Where tests are.
class Stations : public sc_core::sc_module {
 public:
  explicit Stations(const sc_core::sc_module_name& name) : sc_module(name) {}
  /// Asks for the test of pair number `index`; does not wait.
  virtual void request(std::size_t index, std::size_t kind) = 0;
  /// Waits until that test can work.
  virtual Channels& ready(std::size_t index, std::size_t kind) = 0;
  /// Drops all loaded tests.
  virtual void clear() = 0;
  virtual unsigned loads() const = 0;
};

/// All tests side by side.
class StaticTests : public Stations {
 public:
  explicit StaticTests(const sc_core::sc_module_name& name) : Stations(name) {
    for (std::size_t kind = 0; kind < test_kinds.size(); ++kind) {
      tests_.push_back(std::make_unique<TimedTest>(test_kinds[kind].name));
      tests_[kind]->work(channels_[kind].work);
      tests_[kind]->answer(channels_[kind].answer);
    }
  }
  void request(std::size_t, std::size_t) override {}
  Channels& ready(std::size_t, std::size_t kind) override { return channels_.at(kind); }
  void clear() override {}
  unsigned loads() const override { return 0; }

 private:
  std::array<Channels, test_kinds.size()> channels_;
  std::vector<std::unique_ptr<TimedTest>> tests_;
};

auto ports_of(TimedTest& test) { return rc::ports(test.work, test.answer); }
using TestPorts = decltype(ports_of(std::declval<TimedTest&>()));

/// The test made reconfigurable, with its bitstream's length.
class LoadableTest : public rc::reconfigurable<TimedTest> {
 public:
  explicit LoadableTest(const TestKind& kind)
      : reconfigurable(kind.name), bitfile_(static_cast<sc_core::sc_module&>(*this), kind.bitfile_bits) {}

 private:
  rc::bitfile_size bitfile_;
};

/// A place for one test: portals between its FIFOs and any test.
class Slot : public sc_core::sc_module {
 public:
  Channels channels;

  explicit Slot(const sc_core::sc_module_name& name) : sc_module(name) {
    portals_.bind_static(channels.work, channels.answer);
    for (const TestKind& kind : test_kinds) {
      tests_.push_back(std::make_unique<LoadableTest>(kind));
      portals_.bind_dynamic(ports_of(*tests_.back()));
    }
  }
  LoadableTest& test(std::size_t kind) { return *tests_.at(kind); }
  rc::module_set all() {
    rc::module_set set(*tests_[0]);
    for (auto& test : tests_) set += *test;
    return set;
  }

 private:
  rc::portal_group<TestPorts> portals_{"portals", {"work", "answer"}};
  std::vector<std::unique_ptr<LoadableTest>> tests_;
};

/// Slots and the configuration controller (C3) that exchanges their tests.
class SlottedTests : public Stations {
 public:
  SC_HAS_PROCESS(SlottedTests);
  /// `path`: held while a bitstream passes.
  SlottedTests(const sc_core::sc_module_name& name, const Platform& platform, sc_core::sc_mutex& path)
      : Stations(name), control_("control", platform.timing), path_(path) {
    for (unsigned i = 0; i < platform.slots; ++i) {
      slots_.push_back(std::make_unique<Slot>(fmt::format("slot{}", i).c_str()));
      control_.add(slots_[i]->all());
    }
    SC_THREAD(exchange);
  }

  void request(std::size_t index, std::size_t kind) override { requests_.write({index % slots_.size(), kind}); }
  Channels& ready(std::size_t index, std::size_t kind) override {
    Slot& slot = *slots_[index % slots_.size()];
    while (!slot.test(kind).is_active()) wait(exchanged_);
    return slot.channels;
  }
  void clear() override {
    for (auto& slot : slots_) control_.unload(slot->all());
  }
  unsigned loads() const override { return loads_; }

 private:
  struct Request {
    std::size_t slot = 0, kind = 0;
    friend std::ostream& operator<<(std::ostream& out, const Request& r) { return out << r.slot << ':' << r.kind; }
  };

  void exchange() {
    for (;;) {
      const Request request = requests_.read();
      Slot& slot = *slots_[request.slot];
      LoadableTest& test = slot.test(request.kind);
      if (test.is_active()) continue;
      control_.unload(slot.all());
      path_.lock();
      control_.load(test);
      path_.unlock();
      control_.activate(test);
      ++loads_;
      exchanged_.notify();
    }
  }

  std::vector<std::unique_ptr<Slot>> slots_;
  rc::timed_control control_;
  sc_core::sc_mutex& path_;
  sc_core::sc_fifo<Request> requests_{2};
  sc_core::sc_event exchanged_;
  unsigned loads_ = 0;
};

/// The host (API process) with its bus and the tests.
class System : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(System);
  System(const sc_core::sc_module_name& name, const Series& series)
      : sc_module(name), platform_(series.platform), jobs_(series.jobs) {
    if (platform_.slots == 0) {
      tests_ = std::make_unique<StaticTests>("tests");
    } else {
      tests_ = std::make_unique<SlottedTests>("tests", platform_, platform_.single_bus ? bus_ : configuration_path_);
    }
    SC_THREAD(host);
  }

  const std::vector<JobResult>& results() const { return results_; }

 private:
  void host() {
    for (const Job& job : jobs_) results_.push_back(run(job.pairs, job.first_loaded));
  }

  JobResult run(const std::vector<ObjectPair>& pairs, bool first_loaded) {
    const bool ahead = platform_.slots > 1;
    tests_->clear();
    if (first_loaded) {
      tests_->request(0, pairs[0].kind);
      tests_->ready(0, pairs[0].kind);
    }
    const unsigned loads_before = tests_->loads();
    const sc_time start = sc_core::sc_time_stamp();  // NOLINT(performance-*): what is referred to continues
    JobResult result;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i == 0 || !ahead) tests_->request(i, pairs[i].kind);
      transmit(pairs[i].data_bits);
      Channels& channels = tests_->ready(i, pairs[i].kind);
      channels.work.write(pairs[i].tests);
      if (ahead && i + 1 < pairs.size()) tests_->request(i + 1, pairs[i + 1].kind);
      channels.answer.read();
      result.answers.push_back(sc_core::sc_time_stamp() - start);
    }
    result.loads = tests_->loads() - loads_before;
    return result;
  }

  void transmit(std::uint64_t bits) {
    bus_.lock();
    wait(platform_.timing.transmission(bits));
    bus_.unlock();
  }

  Platform platform_;
  std::vector<Job> jobs_;
  std::vector<JobResult> results_;
  sc_core::sc_mutex bus_;
  sc_core::sc_mutex configuration_path_;
  std::unique_ptr<Stations> tests_;
};

void check(const Series& series) {
  if (series.platform.slots > 2) {
    throw std::invalid_argument(fmt::format("a platform with {} slots; give 0, 1 or 2", series.platform.slots));
  }
  for (const Job& job : series.jobs) {
    const bool known = std::all_of(job.pairs.begin(), job.pairs.end(),
                                   [](const ObjectPair& pair) { return pair.kind < test_kinds.size(); });
    if (job.pairs.empty() || !known) {
      throw std::invalid_argument(
          fmt::format("a job needs object pairs, each of a kind below {}; this one has {} pairs", test_kinds.size(),
                      job.pairs.size()));
    }
  }
}

}  // namespace

std::vector<std::vector<JobResult>> simulate(const std::vector<Series>& all) {
  std::vector<std::unique_ptr<System>> systems;
  for (const Series& series : all) {
    check(series);
    systems.push_back(std::make_unique<System>(sc_core::sc_module_name(sc_core::sc_gen_unique_name("system")), series));
  }
  sc_core::sc_start();
  std::vector<std::vector<JobResult>> results;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (systems[i]->results().size() != all[i].jobs.size()) {
      throw std::runtime_error(fmt::format("{}: stopped after {} of {} jobs at {}; something waits for ever",
                                           systems[i]->name(), systems[i]->results().size(), all[i].jobs.size(),
                                           sc_core::sc_time_stamp().to_string()));
    }
    results.push_back(systems[i]->results());
  }
  return results;
}

}  // namespace cchip::table1
