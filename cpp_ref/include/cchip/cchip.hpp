// SPDX-License-Identifier: Apache-2.0
/// \file
/// All that most programs need of the library. Link collisionchip::device, and collisionchip::mesh_io for load_mesh().
#ifndef CCHIP_CCHIP_HPP
#define CCHIP_CCHIP_HPP

#include <cchip/collide/collide.hpp>
#include <cchip/collide/gradual_underflow.hpp>
#include <cchip/collide/intersection.hpp>
#include <cchip/collide/scene.hpp>
#include <cchip/cpu/along.hpp>
#include <cchip/cpu/cpu_device.hpp>
#include <cchip/cpu/distance.hpp>
#include <cchip/cpu/point_cloud.hpp>
#include <cchip/cpu/solids.hpp>
#include <cchip/device/device.hpp>
#include <cchip/mesh/mesh.hpp>
#include <cchip/mesh/shapes.hpp>
#include <cchip/mesh_io/mesh_file.hpp>
#include <cchip/mesh_io/point_file.hpp>

#endif
