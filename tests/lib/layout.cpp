// SPDX-License-Identifier: Apache-2.0
// Sizes and alignments of what callers and library exchange. Compiled for several instruction sets, so it holds
// constants only and no code.
#include "layout.hpp"

#include <cchip/collide.hpp>
#include <cchip/internal/exact/posed_pairs.hpp>
#include <cchip/internal/tree/support_tree.hpp>
#include <cchip/internal/wire/pair.hpp>

namespace cchip_test {

#define CCHIP_LAYOUT_OF(type) sizeof(type), alignof(type)
const Layout CCHIP_LAYOUT = {CCHIP_LAYOUT_OF(cchip::Pose),
                             CCHIP_LAYOUT_OF(decltype(cchip::make_pose({}, {}))),
                             CCHIP_LAYOUT_OF(cchip::PosePair),
                             CCHIP_LAYOUT_OF(cchip::CollisionQuery),
                             CCHIP_LAYOUT_OF(cchip::Object),
                             CCHIP_LAYOUT_OF(cchip::Mesh),
                             CCHIP_LAYOUT_OF(cchip::Mesh::Face),
                             CCHIP_LAYOUT_OF(cchip::Primitive),
                             CCHIP_LAYOUT_OF(cchip::GridPair),
                             CCHIP_LAYOUT_OF(cchip::PosedPairs),
                             CCHIP_LAYOUT_OF(cchip::bvh::SupportTree)};

}  // namespace cchip_test
