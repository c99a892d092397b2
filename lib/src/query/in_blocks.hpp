// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same work for each of many numbers, in threads.
#ifndef CCHIP_QUERY_IN_BLOCKS_HPP
#define CCHIP_QUERY_IN_BLOCKS_HPP

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace cchip {

/// Calls work(i) for i from 0 to count - 1. Each thread makes its `work` by make_work() and takes `block` numbers at a
/// time.
/// \param threads 0: as many as there are cores
/// \throws what the calls throw, after all threads have ended
template <class MakeWork>
void in_blocks(std::size_t count, std::size_t block, unsigned threads, const MakeWork& make_work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    auto work = make_work();
    for (std::size_t begin = next.fetch_add(block); begin < count; begin = next.fetch_add(block)) {
      for (std::size_t i = begin; i < std::min(count, begin + block); ++i) work(i);
    }
  };
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < threads && i * block < count; ++i) {
    others.push_back(std::async(std::launch::async, run));
  }
  run();
  for (std::future<void>& other : others) other.get();
}

}  // namespace cchip

#endif
