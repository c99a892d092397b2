// SPDX-License-Identifier: Apache-2.0
#include "cpu_device.hpp"

#include <algorithm>
#include <atomic>
#include <cchip/collide/face_pairs.hpp>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "dop_pairs.hpp"

namespace cchip {
namespace {

using bvh::NodeKind;
using bvh::TreeNode;

/// Numbers of a node of A and of one of B whose volumes overlap.
struct NodePair {
  std::uint32_t a;
  std::uint32_t b;
};

/// Descends in both trees at once, where the volumes overlap most first. Keeps its memory from query to query.
class Search {
 public:
  CollisionResult run(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                      const CollisionRequest& request) {
    FacePairs faces(a, pose_a, b, pose_b, request);
    const DopPairs volumes(a, pose_a, b, pose_b);
    const bvh::Tree& tree_a = a.tree();
    const bvh::Tree& tree_b = b.tree();
    stack_.clear();
    ++faces.counts().box_tests;
    if (DopPairs::overlap(volumes.volume_a(tree_a.nodes[0].dop), volumes.volume_b(tree_b.nodes[0].dop)) >= 0) {
      stack_.push_back({0, 0});
    }
    while (!stack_.empty() && !faces.done()) {
      const NodePair pair = stack_.back();
      stack_.pop_back();
      const TreeNode& node_a = tree_a.nodes[pair.a];
      const TreeNode& node_b = tree_b.nodes[pair.b];
      if (node_a.kind != NodeKind::inner && node_b.kind != NodeKind::inner) {
        test_leaves(tree_a, node_a, tree_b, node_b, faces);
      } else {
        expand(tree_a, pair.a, tree_b, pair.b, volumes, faces.counts());
      }
    }
    return faces.take();
  }

 private:
  static constexpr std::size_t width = 4;  // children of a node

  struct Range {
    std::uint32_t first;
    std::uint32_t count;
  };
  /// What comes below a node: its children, or itself if it is a leaf.
  static Range below(const bvh::Tree& tree, std::uint32_t number) {
    const TreeNode& node = tree.nodes[number];
    if (node.kind == NodeKind::inner) return {node.first, node.count};
    return {number, 1};
  }

  void expand(const bvh::Tree& tree_a, std::uint32_t number_a, const bvh::Tree& tree_b, std::uint32_t number_b,
              const DopPairs& volumes, CollisionCounts& counts) {
    const Range range_a = below(tree_a, number_a);
    const Range range_b = below(tree_b, number_b);
    std::array<bvh::Dop26, width> volumes_b;
    for (std::uint32_t k = 0; k < range_b.count; ++k) {
      volumes_b[k] = volumes.volume_b(tree_b.nodes[range_b.first + k].dop);
    }
    struct Candidate {
      double depth;
      NodePair pair;
    };
    std::array<Candidate, width * width> found;
    std::size_t count = 0;
    for (std::uint32_t i = range_a.first; i < range_a.first + range_a.count; ++i) {
      const bvh::Dop26 volume_a = volumes.volume_a(tree_a.nodes[i].dop);
      for (std::uint32_t k = 0; k < range_b.count; ++k) {
        const double depth = DopPairs::overlap(volume_a, volumes_b[k]);
        if (depth >= 0) found[count++] = {depth, {i, range_b.first + k}};
      }
    }
    ++counts.steps;
    counts.box_tests += std::uint64_t{range_a.count} * range_b.count;
    // The deepest comes last, on top of the stack; among equals the first.
    std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Candidate& p, const Candidate& q) {
                if (p.depth != q.depth) return p.depth < q.depth;
                return p.pair.a != q.pair.a ? p.pair.a > q.pair.a : p.pair.b > q.pair.b;
              });
    for (std::size_t i = 0; i < count; ++i) stack_.push_back(found[i].pair);
  }

  static void test_leaves(const bvh::Tree& tree_a, const TreeNode& leaf_a, const bvh::Tree& tree_b,
                          const TreeNode& leaf_b, FacePairs& faces) {
    for (std::size_t i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i) {
      for (std::size_t k = leaf_b.first; k < leaf_b.first + leaf_b.count; ++k) {
        faces.test(tree_a.faces[i], tree_b.faces[k]);
        if (faces.done()) return;
      }
    }
  }

  std::vector<NodePair> stack_;
};

class CpuDevice final : public Device {
 public:
  explicit CpuDevice(unsigned threads) : searches_(std::max(1U, threads)) {}

  const char* name() const override { return "cpu"; }

  CollisionResult collide(const Object& a, const Pose& pose_a, const Object& b, const Pose& pose_b,
                          const CollisionRequest& request) override {
    return searches_.front().run(a, pose_a, b, pose_b, request);
  }

  void collide(const Object& a, const Object& b, const std::vector<PosePair>& poses, const CollisionRequest& request,
               const std::function<void(std::size_t, CollisionResult&&)>& take) override {
    for (const PosePair& pose : poses) check_query(pose.a, pose.b, request);
    std::atomic<std::size_t> next = 0;
    std::mutex taking;
    std::exception_ptr error;
    const auto work = [&](Search& search) {
      for (std::size_t i = next++; i < poses.size(); i = next++) {
        try {
          CollisionResult result = search.run(a, poses[i].a, b, poses[i].b, request);
          const std::lock_guard<std::mutex> lock(taking);
          if (!error) take(i, std::move(result));
        } catch (...) {
          const std::lock_guard<std::mutex> lock(taking);
          if (!error) error = std::current_exception();
          next = poses.size();
        }
      }
    };
    std::vector<std::thread> helpers;
    const std::size_t threads = std::min(searches_.size(), poses.size());
    try {
      for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back([&work, this, i] { work(searches_[i]); });
    } catch (const std::system_error&) {
      // The system has no more threads: those that run do all the work.
    }
    work(searches_.front());
    for (std::thread& helper : helpers) helper.join();
    if (error) std::rethrow_exception(error);
  }

 private:
  std::vector<Search> searches_;  // one for each thread
};

}  // namespace

std::unique_ptr<Device> make_cpu_device(unsigned threads) {
  return std::make_unique<CpuDevice>(threads != 0 ? threads : std::thread::hardware_concurrency());
}

}  // namespace cchip
