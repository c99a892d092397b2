// SPDX-License-Identifier: Apache-2.0
/// Timed model of section 3.2: a host sends object pairs over a bus to primitive tests that are all present (static),
/// or that are loaded into one slot or two before they are needed.
#ifndef CCHIP_TABLE1_SYSTEM_HPP
#define CCHIP_TABLE1_SYSTEM_HPP

#include <array>
#include <cchip/rc/bitstream_timing.hpp>
#include <cstdint>
#include <systemc>
#include <vector>

namespace cchip::table1 {

/// A primitive test and its bitstream.
struct TestKind {
  const char* name;
  std::uint64_t bitfile_bits;
};

/// Sizes of the paper's two tests; those of the others are not in the paper, the mean of the two is assumed.
inline constexpr std::uint64_t mean_bitfile_bits = (5'504'088 + 5'409'976) / 2;
inline constexpr std::array<TestKind, 4> test_kinds = {{{"tri_tri", 5'504'088},
                                                        {"quad_quad", 5'409'976},
                                                        {"tri_quad", mean_bitfile_bits},
                                                        {"point_tri", mean_bitfile_bits}}};

/// Two objects to be tested against each other.
struct ObjectPair {
  std::size_t kind;         ///< index into test_kinds
  sc_core::sc_time tests;   ///< how long the primitive tests of this pair take together
  std::uint64_t data_bits;  ///< that the host sends first
};

struct Platform {
  unsigned slots = 1;      ///< 0: all tests are present; 1; 2: the next test is loaded while the present one works
  bool single_bus = true;  ///< bitstreams pass over the bus of the data (the paper), else over a path of their own
  rc::bitstream_timing timing;
};

/// Object pairs one after the other.
struct Job {
  std::vector<ObjectPair> pairs;
  bool first_loaded = false;  ///< the first pair's test is loaded when time begins to count
};

/// One platform and all its jobs.
struct Series {
  Platform platform;
  std::vector<Job> jobs;
};

struct JobResult {
  std::vector<sc_core::sc_time> answers;  ///< time of each pair's answer since the job began
  unsigned loads = 0;                     ///< while time was counted
};

/// Simulates all series, each on its own platform. Once per process (one elaboration).
/// Errors: a job without pairs, a kind or number of slots that does not exist, a simulation that stops early.
std::vector<std::vector<JobResult>> simulate(const std::vector<Series>& all);

}  // namespace cchip::table1

#endif  // CCHIP_TABLE1_SYSTEM_HPP
