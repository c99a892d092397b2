// SPDX-License-Identifier: Apache-2.0
/// \file
/// Distances by Python's libraries: distance_python.py, which says what the lines mean.
#ifndef CCHIP_BENCH_DISTANCE_PYTHON_HPP
#define CCHIP_BENCH_DISTANCE_PYTHON_HPP

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "distance_count.hpp"

namespace cchip::testing {

/// Answers of one library to the queries of a row, and mean microseconds of its calls.
struct PythonAnswers {
  std::string name;
  std::string version;
  double tolerance = 0;
  DistanceCount count;
  std::array<double, 4> times = {};  ///< distance, within half, within twice, yes or no
};

/// \param script distance_python.py
/// \param queries a file to write
/// \throws std::runtime_error the script fails
inline std::vector<PythonAnswers> ask_python(const std::string& python, const std::string& script,
                                             const std::string& queries, const Mesh& a, const Mesh& b,
                                             const std::vector<PosePair>& poses,
                                             const std::vector<TrueDistance>& right) {
  {
    const std::filesystem::path folder = std::filesystem::path(queries).parent_path();
    if (!folder.empty()) std::filesystem::create_directories(folder);
    std::ofstream file(queries);
    file << std::hexfloat;
    for (const Mesh* mesh : {&a, &b}) {
      for (const Vec3d& v : mesh->vertices) file << v.x() << ' ' << v.y() << ' ' << v.z() << ' ';
      file << '\n';
      for (const Mesh::Face& face : mesh->faces) {
        const auto& v = face.vertex;
        file << v[0] << ' ' << v[1] << ' ' << v[2] << ' ';
        if (face.kind != Kind::tri) file << v[0] << ' ' << v[2] << ' ' << v[3] << ' ';
      }
      file << '\n';
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (const Pose* pose : {&poses[i].a, &poses[i].b}) {
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 4; ++column) file << (*pose)(row, column) << ' ';
        }
      }
      file << half_distance(right[i]) << ' ' << twice_distance(right[i]) << '\n';
    }
    if (!file.flush()) throw std::runtime_error(queries + ": cannot be written; name another with --python-queries");
  }
  const std::string command = "'" + python + "' -B '" + script + "' '" + queries + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw std::runtime_error(command + ": does not start; leave --python out");
  std::vector<PythonAnswers> result;
  const auto number = [&pipe, &command] {
    std::array<char, 64> word = {};
    char* end = nullptr;
    if (std::fscanf(pipe.get(), "%63s", word.data()) != 1) {
      throw std::runtime_error(command + ": ended too early; run it alone to see why");
    }
    const double value = std::strtod(word.data(), &end);
    if (*end != 0) throw std::runtime_error(command + ": " + word.data() + " is no number");
    return value;
  };
  std::array<char, 64> name = {};
  std::array<char, 64> version = {};
  while (std::fscanf(pipe.get(), "%63s %63s", name.data(), version.data()) == 2) {
    PythonAnswers answers;
    answers.name = name.data();
    answers.version = version.data();
    answers.tolerance = number();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      PeerDistance claim;
      claim.distance = number();
      for (double& x : claim.point_a) x = number();
      for (double& x : claim.point_b) x = number();
      answers.count.add_answer(claim, right[i], answers.tolerance, a, b, poses[i]);
      for (const double d : {half_distance(right[i]), twice_distance(right[i]), 0.0}) {
        answers.count.add_decision(number() != 0, d, right[i], answers.tolerance);
      }
      for (double& time : answers.times) time += number() / static_cast<double>(poses.size());
    }
    result.push_back(answers);
  }
  if (result.empty()) throw std::runtime_error(command + ": no answer; run scripts/run peers, or leave --python out");
  return result;
}

}  // namespace cchip::testing

#endif
