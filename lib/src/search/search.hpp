// SPDX-License-Identifier: Apache-2.0
/// \file
/// Searches for faces that touch: what one thread of the CPU device runs.
#ifndef CCHIP_SEARCH_SEARCH_HPP
#define CCHIP_SEARCH_SEARCH_HPP

#include <algorithm>
#include <cchip/collide.hpp>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace cchip {

/// How the threads of a batch divide it.
struct Partition {
  std::size_t share;  ///< queries that a thread takes from the batch at a time
  std::size_t
      at_once;  ///< queries of a thread that are begun and not answered: full shares, within its part of the batch
};
/// \pre 0 < threads <= count
inline Partition partition_of(std::size_t count, std::size_t threads) {
  const std::size_t share = std::clamp<std::size_t>(count / (4 * threads), 1, 32);
  return {share, count / threads / share * share};
}

/// Gives a search its queries and takes the results. A query that is far apart costs as much as some dozen indirect
/// calls, so there is one to fetch it and one to hand its result over.
class QueryFeed {
 public:
  explicit QueryFeed(const Device::QuerySource& source) : source_(source) {}
  virtual ~QueryFeed() = default;
  /// Queries that the search may have begun at a time; it may do with fewer.
  virtual std::size_t at_once() const { return std::numeric_limits<std::size_t>::max(); }
  /// The number of the next query; false: no more.
  bool next(std::size_t& number) {
    if (at_ == end_ && !next_share(at_, end_)) return false;
    number = at_++;
    return true;
  }
  /// The query. Returned where it is used: a copy of what was just written number by number stalls the processor.
  CollisionQuery query(std::size_t number) const { return source_(number); }
  /// The result may be changed, for instance swapped with another one whose memory the search shall use.
  virtual void done(std::size_t number, CollisionResult& result) = 0;

 private:
  /// The next queries are those from `first` up to `end`, without it; false: no more.
  virtual bool next_share(std::size_t& first, std::size_t& end) = 0;

  const Device::QuerySource& source_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;
};

/// Keeps its memory from query to query. For one thread at a time.
class Search {
 public:
  virtual ~Search() = default;
  /// \pre check_query() accepts the query
  virtual void run(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) = 0;
  /// Many queries, several at a time.
  virtual void run(QueryFeed& feed, const CollisionRequest& request) = 0;
};

/// Factors on the bounds that make the answers exact (docs/cpp/exactness.md); 1 but in tests, which show that the
/// answers are wrong without them.
struct Margins {
  double far = 1;       ///< whole objects along an axis, in doubles
  double narrow = 1;    ///< planes in 16 bits
  double wide = 1;      ///< planes in single precision
  double vertex = 1;    ///< vertices in single precision
  double relation = 1;  ///< how the objects lie to each other, in doubles
};

/// Directions and planes in doubles, a pair of nodes at a time; takes every query.
std::unique_ptr<Search> make_plain_search();

/// Instruction sets that this computer has and the searches below use, best first.
std::vector<std::string> simd_targets();
/// 16-bit planes, several queries in lock step; leaves what it cannot relate well to the plain search.
/// \param target one of simd_targets()
std::unique_ptr<Search> make_simd_search(const std::string& target, const Margins& margins = {});

}  // namespace cchip

#endif
