// SPDX-License-Identifier: Apache-2.0
// Any bytes as an image of an object, with the right CRC. What passes the check is used: queries of the image against
// itself end.
#include <cchip/internal/image/image.hpp>
#include <cchip/internal/image/place.hpp>
#include <cchip/internal/model/broad_phase.hpp>

#include "require.hpp"

using namespace cchip;

namespace {

void use(const Bytes& bytes) {
  try {
    const bvh::Image image = bvh::parse_image(bytes);
    require(bvh::to_bytes(image) == bytes, "an image keeps its bytes");
    const auto query = bvh::make_query(image.header(), Eigen::Affine3d::Identity(), image.header(),
                                       Eigen::Affine3d(Eigen::Translation3d(0.125, 0, 0)));
    if (!query) return;
    model::BroadPhaseOptions options;
    options.step_limit = 200;
    const QueryCode code = model::run_query(*query, image, image, options).done.code;
    require(code != QueryCode::corrupt && code != QueryCode::outside && code != QueryCode::bad_descriptor,
            "the chip takes what the check lets pass");
  } catch (const bvh::ImageError& error) {
    require_one_line(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, data + size);
  constexpr std::size_t from = bvh::header_field::crc.end() / 8;
  if (size >= from) {
    const std::uint32_t crc = crc32(bytes.data() + from, size - from);
    for (std::size_t i = 0; i < 4; ++i) bytes[from - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
  use(bytes);
  return 0;
}
