// SPDX-License-Identifier: Apache-2.0
#include "model_device.hpp"

#include <algorithm>
#include <cchip/bvh/image.hpp>
#include <cchip/bvh/place.hpp>
#include <cchip/collide/face_pairs.hpp>
#include <cchip/device/cpu_device.hpp>
#include <cchip/model/broad_phase.hpp>
#include <iterator>
#include <list>
#include <optional>
#include <stdexcept>

namespace cchip {
namespace {

/// Images of the objects that were asked for last.
class ImageCache {
 public:
  /// The image of an object, made if it is not kept; null if the object is too large for one. Valid until `most` other
  /// objects were asked for.
  const bvh::Image* of(const Object& object) {
    const auto found =
        std::find_if(items_.begin(), items_.end(), [&object](const Item& x) { return x.object.id() == object.id(); });
    if (found != items_.end()) {
      items_.splice(items_.begin(), items_, found);
    } else {
      if (items_.size() == most) items_.pop_back();
      items_.push_front({object, image_of(object)});
    }
    const Item& item = items_.front();
    return item.image ? &*item.image : nullptr;
  }

 private:
  static constexpr std::size_t most = 8;

  struct Item {
    Object object;  // keeps id() from being given to another object
    std::optional<bvh::Image> image;
  };

  static std::optional<bvh::Image> image_of(const Object& object) {
    try {
      return bvh::make_image(object.mesh(), bvh::build_tree(object.mesh()));
    } catch (const std::invalid_argument&) {  // more lines than an image holds
      return std::nullopt;
    }
  }

  std::list<Item> items_;  // the last one asked for first
};

class ModelDevice final : public Device {
 public:
  const char* name() const override { return "model"; }

 private:
  void answer(const CollisionQuery& query, const CollisionRequest& request, CollisionResult& result) override {
    const std::optional<model::BroadPhaseResult> from_chip = ask(query, request);
    if (!from_chip) return cpu_->collide(query, request, result);
    CollisionCounts counts;
    counts.steps = from_chip->counts.steps;
    counts.box_tests = from_chip->counts.box_tests;
    counts.pairs = from_chip->counts.primitive_pairs;
    const QueryCode code = from_chip->done.code;
    if (code == QueryCode::ok || code == QueryCode::host) {
      faces_.start(query, request, result);
      counts.open = resolve(from_chip->pairs, faces_);
      if (code == QueryCode::ok || faces_.done()) {
        faces_.finish();
        result.counts = counts;
        return;
      }
    }
    cpu_->collide(query, request, result);
    result.counts += counts;
  }

  /// What the chip says; nothing if it does not take the query.
  std::optional<model::BroadPhaseResult> ask(const CollisionQuery& placed, const CollisionRequest& request) {
    const bvh::Image* image_a = images_.of(*placed.a);
    const bvh::Image* image_b = images_.of(*placed.b);
    if (image_a == nullptr || image_b == nullptr) return std::nullopt;
    std::optional<Query> query = bvh::make_query(image_a->header(), *placed.pose_a, image_b->header(), *placed.pose_b);
    if (!query) return std::nullopt;
    query->mode = request.contacts == CollisionRequest::Contacts::all ? QueryMode::all : QueryMode::first;
    if (query->swapped) std::swap(image_a, image_b);
    return model::run_query(*query, *image_a, *image_b);
  }

  /// Decides open pairs exactly until the request is fulfilled. The last pair goes first: the chip ends a FIRST query
  /// with the pair that is in contact for certain.
  /// \returns how many pairs were open
  static std::uint64_t resolve(const std::vector<PairRecord>& pairs, FacePairs& faces) {
    std::uint64_t open = 0;
    for (auto pair = pairs.rbegin(); pair != pairs.rend() && !faces.done(); ++pair) {
      if (pair->definite) {
        faces.add(pair->id_a, pair->id_b);
      } else {
        faces.test(pair->id_a, pair->id_b);
        ++open;
      }
    }
    return open;
  }

  ImageCache images_;
  FacePairs faces_;
  std::unique_ptr<Device> cpu_ = open_cpu_device({1, {}});
};

}  // namespace

std::unique_ptr<Device> make_model_device() { return std::make_unique<ModelDevice>(); }

}  // namespace cchip
