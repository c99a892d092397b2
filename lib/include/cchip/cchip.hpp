// SPDX-License-Identifier: Apache-2.0
/// \file
/// All that most programs need of the library. Link collisionchip::device, and collisionchip::mesh_io for load_mesh().
#ifndef CCHIP_CCHIP_HPP
#define CCHIP_CCHIP_HPP

#include <cchip/along.hpp>
#include <cchip/collide.hpp>
#include <cchip/cpu_device.hpp>
#include <cchip/device.hpp>
#include <cchip/distance.hpp>
#include <cchip/gradual_underflow.hpp>
#include <cchip/intersection.hpp>
#include <cchip/mesh.hpp>
#include <cchip/mesh_file.hpp>
#include <cchip/point_cloud.hpp>
#include <cchip/point_file.hpp>
#include <cchip/scene.hpp>
#include <cchip/shapes.hpp>
#include <cchip/solids.hpp>

#endif
