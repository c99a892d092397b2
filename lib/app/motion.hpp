// SPDX-License-Identifier: Apache-2.0
/// \file
/// `cchip clash --path`: reads a path and says what happens on it.
#ifndef CCHIP_APP_MOTION_HPP
#define CCHIP_APP_MOTION_HPP

#include <cchip/assembly_motion.hpp>
#include <ostream>
#include <string>

#include "cli.hpp"

namespace cchip::app {

/// Of a robot, columns named as joints; or columns part, tx, ty, tz and a rotation as PoseColumns, the n-th row of each
/// part in configuration n.
/// \throws UsageError
AssemblyMotion read_motion(const std::string& path, const Assembly& assembly);

void write_table(const Assembly& assembly, const MotionReport& report, std::ostream& out);
std::string json_text(const Assembly& assembly, const MotionReport& report);
std::string junit_text(const Assembly& assembly, const MotionReport& report, const std::string& path);
/// "parts=N pairs=N violations=N unproved=N looks=N"
std::string summary(const Assembly& assembly, const MotionReport& report);

/// How many pairs are left out; empty: none.
std::string left_out_line(const Assembly& assembly);

/// Text in XML 1.0, in which control characters cannot be written at all.
std::string xml_text(const std::string& text);

}  // namespace cchip::app

#endif
