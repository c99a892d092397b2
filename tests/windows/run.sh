#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compiles the C++ library, an example and the sources of the Python module for Windows on x86-64. Nothing is run.
#
# usage: run.sh FOLDER      FOLDER is made, and keeps what was built
# Needs Debian's g++-mingw-w64-x86-64-posix and dpkg-dev, and nanobind (NANOBIND=<folder of the Python package>). Eigen,
# Boost and Python's headers are those of this computer; Highway is built from Debian's sources.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
for tool in x86_64-w64-mingw32-g++-posix apt-get dpkg-source; do
  command -v "$tool" > /dev/null || {
    echo "run.sh: no $tool; install Debian's g++-mingw-w64-x86-64-posix and dpkg-dev" >&2
    exit 1
  }
done
if [ ! -d "${NANOBIND:-}/include" ]; then
  echo "run.sh: NANOBIND names no folder of nanobind; start it by: scripts/run cross-windows" >&2
  exit 1
fi

# Links to the headers that depend on no system: all of /usr/include would mix the two systems' headers.
mkdir -p "$folder/include"
ln -sfn /usr/include/boost "$folder/include/boost"
mkdir -p "$folder/python"
for header in "$(python3 -c 'import sysconfig; print(sysconfig.get_paths()["include"])')"/*; do
  [ "$(basename "$header")" = pyconfig.h ] || ln -sfn "$header" "$folder/python/"
done

toolchain=$root/tests/windows/toolchain.cmake
if [ ! -d "$folder/highway" ]; then
  apt=$folder/apt
  rm -rf "$apt"
  mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/lists" "$apt/source"
  # the sources beside the packages of this computer's lists
  if [ -f /etc/apt/sources.list ]; then
    sed -n 's/^deb \(.*\)/deb-src \1/p' /etc/apt/sources.list > "$apt/lists/debian.list"
  fi
  for list in /etc/apt/sources.list.d/debian*.sources; do
    [ -f "$list" ] && sed 's/^Types:.*/Types: deb-src/' "$list" > "$apt/lists/$(basename "$list")"
  done
  : > "$apt/list"
  options=(-qq -o "Dir::State=$apt/state" -o "Dir::Cache=$apt/cache" -o "Dir::Etc::sourcelist=$apt/list"
    -o "Dir::Etc::sourceparts=$apt/lists" -o "APT::Sandbox::User=$(id -un)")
  apt-get "${options[@]}" update
  (cd "$apt/source" && apt-get "${options[@]}" source --download-only highway && dpkg-source --extract highway_*.dsc tree > /dev/null)
  cmake -S "$apt/source/tree" -B "$folder/highway_build" -D CMAKE_TOOLCHAIN_FILE="$toolchain" -D CMAKE_BUILD_TYPE=Release \
    -D BUILD_TESTING=OFF -D HWY_ENABLE_TESTS=OFF -D HWY_ENABLE_EXAMPLES=OFF -D HWY_ENABLE_CONTRIB=OFF -D BUILD_SHARED_LIBS=OFF \
    -D CMAKE_INSTALL_PREFIX="$folder/highway.part"
  cmake --build "$folder/highway_build" --parallel "${JOBS:-1}"
  rm -rf "$folder/highway.part"
  cmake --install "$folder/highway_build" > /dev/null
  mv "$folder/highway.part" "$folder/highway"
fi

cmake -S "$root/tests/windows" -B "$folder/build" -D CMAKE_TOOLCHAIN_FILE="$toolchain" -D CMAKE_BUILD_TYPE=Release \
  -D Eigen3_DIR=/usr/share/eigen3/cmake -D Boost_NO_BOOST_CMAKE=ON -D Boost_INCLUDE_DIR="$folder/include" \
  -D CMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON -D hwy_DIR="$folder/highway/lib/cmake/hwy" \
  -D CCHIP_NANOBIND_INCLUDE_DIR="$NANOBIND/include" -D CCHIP_PYTHON_INCLUDE_DIR="$folder/python"
cmake --build "$folder/build" --parallel "${JOBS:-1}"
# The stack of Windows is aligned to 16 bytes: no vector of 32 or 64 may be moved to memory as if it were aligned to as many.
for object in "$folder"/build/collisionchip/lib/CMakeFiles/cchip_device.dir/src/search/*.obj; do
  if x86_64-w64-mingw32-objdump -d --no-show-raw-insn "$object" | grep -E 'vmov(ap[sd]|dqa)' | grep -E '%[yz]mm' | grep '('; then
    echo "run.sh: $object moves vectors to memory that may not be aligned" >&2
    exit 1
  fi
done
echo "compiled for Windows; nothing was run: $folder/build/collide.exe"
