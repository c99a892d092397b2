#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compiles the C++ library and tests of it for 64-bit ARM and runs them by emulation.
#
# usage: run.sh FOLDER      FOLDER is made, and keeps what was built
# Needs Debian's g++-aarch64-linux-gnu and qemu-user-static. Eigen, Boost and Catch2 are the headers of this computer;
# Highway is a library, whose ARM package is unpacked below FOLDER, without an installation.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
for tool in aarch64-linux-gnu-g++ qemu-aarch64-static apt-get dpkg-deb; do
  command -v "$tool" > /dev/null || {
    echo "run.sh: no $tool; install Debian's g++-aarch64-linux-gnu and qemu-user-static" >&2
    exit 1
  }
done

# Links to the headers that depend on no architecture: all of /usr/include would mix the two systems' headers.
mkdir -p "$folder/include"
ln -sfn /usr/include/boost "$folder/include/boost"
ln -sfn /usr/include/catch2 "$folder/include/catch2"

if [ ! -d "$folder/highway/usr" ]; then
  apt=$folder/apt
  mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/packages"
  : > "$apt/status"
  options=(-qq -o "Dir::State=$apt/state" -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt/cache"
    -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o "APT::Sandbox::User=$(id -un)")
  apt-get "${options[@]}" update
  (cd "$apt/packages" && apt-get "${options[@]}" download libhwy1 libhwy-dev)
  for package in "$apt"/packages/*.deb; do dpkg-deb --extract "$package" "$folder/highway.part"; done
  mv "$folder/highway.part" "$folder/highway"
fi

cmake -S "$root/tests/arm64" -B "$folder/build" -D CMAKE_TOOLCHAIN_FILE="$root/tests/arm64/toolchain.cmake" \
  -D CMAKE_BUILD_TYPE=Release -D Eigen3_DIR=/usr/share/eigen3/cmake -D Boost_NO_BOOST_CMAKE=ON \
  -D Boost_INCLUDE_DIR="$folder/include" -D CCHIP_CATCH_INCLUDE_DIR="$folder/include" \
  -D CMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON -D hwy_DIR="$folder/highway/usr/lib/aarch64-linux-gnu/cmake/hwy"
cmake --build "$folder/build" --parallel "${JOBS:-1}"
ctest --test-dir "$folder/build" --no-tests=error --output-on-failure
