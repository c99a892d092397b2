// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same for many things in several threads.
#ifndef CCHIP_ASSEMBLY_RUN_ALL_HPP
#define CCHIP_ASSEMBLY_RUN_ALL_HPP

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cchip::assembly {

/// Calls `run` for 0..count - 1 in several threads. Of several exceptions that of the least number is thrown.
template <class Function>
void run_all(std::size_t count, unsigned threads, const Function& run) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t failed = count;
  std::exception_ptr error;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        run(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (i < failed) {
          failed = i;
          error = std::current_exception();
        }
      }
    }
  };
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min<std::size_t>(threads, count); ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace cchip::assembly

#endif
