// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cchip/certify.hpp>
#include <cchip/cpu_device.hpp>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "search/search.hpp"

namespace cchip {
namespace {

constexpr const char* plain = "plain";

std::unique_ptr<Search> make_search(const std::string& target) {
  return target == plain ? make_plain_search() : make_simd_search(target);
}

/// A batch that one or several threads answer. Several take some queries each at a time and keep results until they
/// have as many.
class Batch {
 public:
  Batch(std::size_t count, std::size_t threads, const Device::QuerySource& query, const CollisionRequest& request,
        const Device::ResultSink& take)
      : count_(count),
        alone_(threads == 1),
        partition_(partition_of(count, threads)),
        query_(query),
        request_(request),
        take_(take) {}

  /// What one thread does.
  void work(Search& search, std::vector<std::pair<std::size_t, CollisionResult>>& kept) {
    try {
      Feed feed(*this, kept);
      search.run(feed, request_);
      feed.hand_over();
    } catch (...) {
      stop(std::current_exception());
    }
  }

  /// Call it when all threads are done.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// Contacts for which a result keeps its memory from query to query and from batch to batch.
  static constexpr std::size_t most_kept = 4096;

  class Feed final : public QueryFeed {
   public:
    Feed(Batch& batch, std::vector<std::pair<std::size_t, CollisionResult>>& kept)
        : QueryFeed(batch.query_), batch_(batch), kept_(kept) {
      if (!batch_.alone_ && kept_.size() < share_) kept_.resize(share_);
    }
    std::size_t at_once() const override { return batch_.partition_.at_once; }
    void done(std::size_t number, CollisionResult& result) override {
      if (batch_.request_.certificate) {
        add_certificate(batch_.query_(number), batch_.request_, result);
      } else if (result.certificate) {  // of a batch that an exception has ended
        result.certificate.reset();
      }
      if (batch_.alone_) return give(number, result);
      CollisionResult& mine = kept_[kept_count_].second;
      kept_[kept_count_].first = number;
      if (result.contacts.empty()) {  // as of most pairs that are far apart: a copy costs less than a swap
        mine.hit = result.hit;
        mine.relation = result.relation;
        mine.contacts.clear();
        mine.stats = result.stats;
        if (mine.certificate || result.certificate) mine.certificate = std::move(result.certificate);
      } else {
        std::swap(mine, result);
      }
      if (++kept_count_ == share_ || mine.contacts.size() > most_kept) hand_over();
    }
    void hand_over() {
      if (kept_count_ == 0) return;
      const std::lock_guard<std::mutex> lock(batch_.taking_);
      try {
        for (std::size_t i = 0; i < kept_count_ && !batch_.error_; ++i) give(kept_[i].first, kept_[i].second);
      } catch (...) {
        // Noted before the lock is released: another thread may wait for it to hand over its results.
        batch_.error_ = std::current_exception();
        throw;
      }
      kept_count_ = 0;
    }

   private:
    bool next_share(std::size_t& first, std::size_t& end) override {
      first = std::min(batch_.next_.fetch_add(share_), batch_.count_);
      end = std::min(first + share_, batch_.count_);
      return first != end;
    }
    void give(std::size_t number, CollisionResult& result) {
      batch_.take_(number, result);
      if (result.certificate) result.certificate.reset();
      if (result.contacts.capacity() > most_kept) std::vector<Contact>().swap(result.contacts);
    }

    Batch& batch_;
    const std::size_t share_ = batch_.partition_.share;
    std::vector<std::pair<std::size_t, CollisionResult>>& kept_;
    std::size_t kept_count_ = 0;
  };

  void stop(std::exception_ptr error) {
    next_ = count_;
    const std::lock_guard<std::mutex> lock(taking_);
    if (!error_) error_ = std::move(error);
  }

  const std::size_t count_;
  const bool alone_;  // one thread: nothing to keep, no lock
  const Partition partition_;
  const Device::QuerySource& query_;
  const CollisionRequest& request_;
  const Device::ResultSink& take_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex taking_;
  std::exception_ptr error_;
};

/// A search and, once a batch was offered, a thread for it, which waits for batches.
class Worker {
 public:
  explicit Worker(const std::string& target) : search_(make_search(target)) {}
  ~Worker() {
    leave_thread_of_parent();
    if (!helper_) return;
    {
      const std::lock_guard<std::mutex> lock(helper_->mutex);
      helper_->end = true;
    }
    helper_->changed.notify_one();
    helper_->thread.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Offers the batch; end() it. Does nothing if the system has no more threads or no memory for one.
  void begin(Batch& batch) {
    leave_thread_of_parent();
    try {
      if (!helper_) start_thread();
    } catch (const std::exception&) {
      return;
    }
    {
      const std::lock_guard<std::mutex> lock(helper_->mutex);
      helper_->offered = &batch;
    }
    helper_->changed.notify_one();
  }
  /// Takes the offer back if the thread has not come to it yet, as on a busy computer; otherwise waits until it is
  /// done.
  void end() {
    if (!helper_) return;
    std::unique_lock<std::mutex> lock(helper_->mutex);
    helper_->offered = nullptr;
    helper_->changed.wait(lock, [this] { return !helper_->working; });
  }
  /// Works at the batch in the caller's thread.
  void work(Batch& batch) { batch.work(*search_, kept_); }
  Search& search() { return *search_; }

 private:
  /// The thread and what it shares with the one that offers batches.
  struct Helper {
    std::mutex mutex;
    std::condition_variable changed;
    Batch* offered = nullptr;
    bool working = false;
    bool end = false;
    std::thread thread;
  };

  void start_thread() {
    auto helper = std::make_unique<Helper>();
    helper->thread = std::thread([this, &shared = *helper] { loop(shared); });
    helper_ = std::move(helper);
    process_ = getpid();
  }
  /// After fork() the child has what the thread shared, but not the thread: it cannot be joined, and what it waits for
  /// must not be destroyed. So the child leaves it where it is.
  void leave_thread_of_parent() {
    if (helper_ && process_ != getpid()) static_cast<void>(helper_.release());
  }

  void loop(Helper& shared) {
    std::unique_lock<std::mutex> lock(shared.mutex);
    while (true) {
      shared.changed.wait(lock, [&shared] { return shared.offered != nullptr || shared.end; });
      if (shared.end) return;
      Batch& batch = *shared.offered;
      shared.offered = nullptr;
      shared.working = true;
      lock.unlock();
      work(batch);
      lock.lock();
      shared.working = false;
      shared.changed.notify_one();
    }
  }

  std::unique_ptr<Search> search_;
  std::vector<std::pair<std::size_t, CollisionResult>> kept_;
  std::unique_ptr<Helper> helper_;
  pid_t process_ = 0;  // that started the thread
};

/// Workers that were offered a batch: it lasts until the destructor has waited for all of them.
class Helpers {
 public:
  explicit Helpers(const std::vector<std::unique_ptr<Worker>>& workers) : workers_(workers) {}
  ~Helpers() {
    for (std::size_t i = 1; i < end_; ++i) workers_[i]->end();
  }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;
  /// Offers the batch to workers 1..end - 1.
  void begin(Batch& batch, std::size_t end) {
    for (; end_ < end; ++end_) workers_[end_]->begin(batch);
  }

 private:
  const std::vector<std::unique_ptr<Worker>>& workers_;
  std::size_t end_ = 1;
};

class CpuDevice final : public Device {
 public:
  CpuDevice(unsigned threads, const std::string& target) {
    for (unsigned i = 0; i < std::max(1U, threads); ++i) workers_.push_back(std::make_unique<Worker>(target));
  }

  const char* name() const override { return "cpu"; }

 private:
  void answer(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    workers_.front()->search().run(query, request, result);
    if (request.certificate) add_certificate(query, request, result);
  }

  void answer_all(std::size_t count, const QuerySource& query, const CollisionRequest& request,
                  const ResultSink& take) override {
    if (count == 0) return;
    const std::size_t threads = std::min(workers_.size(), count);
    Batch batch(count, threads, query, request, take);
    {
      Helpers helpers(workers_);
      helpers.begin(batch, threads);
      workers_.front()->work(batch);
    }
    batch.rethrow();
  }

  std::vector<std::unique_ptr<Worker>> workers_;  // the first one works in the caller's thread
};

}  // namespace

std::vector<std::string> cpu_targets() {
  std::vector<std::string> targets = simd_targets();
  targets.emplace_back(plain);
  return targets;
}

std::unique_ptr<Device> open_cpu_device(const CpuOptions& options) {
  const std::vector<std::string> targets = cpu_targets();
  const std::string target = options.target.empty() ? targets.front() : options.target;
  if (std::find(targets.begin(), targets.end(), target) == targets.end()) {
    std::string known;
    for (const std::string& name : targets) known += (known.empty() ? "" : ", ") + name;
    throw std::invalid_argument("instruction set " + target + " is not known on this computer: there are " + known);
  }
  return std::make_unique<CpuDevice>(options.threads != 0 ? options.threads : std::thread::hardware_concurrency(),
                                     target);
}

CollisionResult collide(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                        const CollisionRequest& request, const CollisionHint& hint) {
  // Destructors of static objects run after those of their thread's own: they get a device for the one call.
  thread_local bool is_gone = false;
  struct Own {
    ~Own() { is_gone = true; }
    const std::unique_ptr<Device> device = open_cpu_device({1, {}});
  };
  if (is_gone) return collide(*open_cpu_device({1, {}}), a, pose_a, b, pose_b, request, hint);
  thread_local const Own own;
  return collide(*own.device, a, pose_a, b, pose_b, request, hint);
}

}  // namespace cchip
