// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which rule counts for a pair of parts?
#ifndef CCHIP_ASSEMBLY_RULE_BOOK_HPP
#define CCHIP_ASSEMBLY_RULE_BOOK_HPP

#include <cchip/assembly.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cchip::assembly {

/// Refers to the assembly, which must stay as it is.
class RuleBook {
 public:
  /// \throws std::invalid_argument a name is there twice, or a rule makes no sense
  explicit RuleBook(const Assembly& assembly);

  /// The number of the rule that counts for two parts. Takes O(rules about groups) time.
  std::optional<std::size_t> rule_of(std::size_t a, std::size_t b) const;
  /// Is a pair not to be looked at?
  bool is_left_out(std::size_t a, std::size_t b) const;
  /// How far apart two parts must be at least.
  double clearance_of(std::size_t a, std::size_t b) const;
  /// All clearances above 0, ascending.
  std::vector<double> clearances() const;
  /// May part a be the first one of a rule about two parts or groups, and b the second?
  bool is_in_order(std::size_t rule, std::size_t a, std::size_t b) const;
  /// Calls `visit` for each pair, a < b, that a rule is about, until it returns false. Other rules may count for it.
  void for_each_pair(std::size_t rule, const std::function<bool(std::size_t, std::size_t)>& visit) const;

 private:
  void add_parts(std::size_t rule);
  bool is_in(std::size_t part, const std::string& group) const;

  const Assembly& assembly_;
  std::map<std::string, std::size_t> part_of_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> of_parts_;  ///< the lower part first
  std::set<std::pair<std::size_t, std::size_t>> left_out_;
  std::vector<std::size_t> of_groups_;  ///< the last one first
  std::optional<std::size_t> of_all_;
};

}  // namespace cchip::assembly

#endif
