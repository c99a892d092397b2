#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: libcxx.sh SOURCE FOLDER     builds the library with clang's libc++ and runs a query and tests; 77: no libc++
set -euo pipefail
source=$1
mkdir -p "$2"
cd "$2"
flags=(-std=c++17 -stdlib=libc++)
if ! echo '#include <string>' | clang++ "${flags[@]}" -x c++ -fsyntax-only - 2> /dev/null; then
  echo "skipped: no clang++ with libc++; install Debian's clang, libc++-14-dev and libc++abi-14-dev"
  exit 77
fi
clang++ "${flags[@]}" -I"$source/lib/include" -I"$source/lib/program/include" "$source/tests/catch_main.cpp" \
  "$source/tests/lib/test_decimal.cpp" -o test_decimal
./test_decimal
cmake -S "$source" -B library -D CMAKE_CXX_COMPILER=clang++ -D CMAKE_CXX_FLAGS=-stdlib=libc++ -D CMAKE_INSTALL_PREFIX="$PWD/prefix" \
  -D CCHIP_SIMULATION=OFF -D BUILD_TESTING=OFF -D CCHIP_WERROR=ON
cmake --build library --target install
cmake -S "$source/tests/install/consumer" -B consumer -D CMAKE_CXX_COMPILER=clang++ -D CMAKE_CXX_FLAGS=-stdlib=libc++ \
  -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH="$PWD/prefix"
cmake --build consumer
[ "$(consumer/consumer)" = $'touch: 0, pairs of faces: 0\ntouch: 1, pairs of faces: 708\ntouch: 1, pairs of faces: 834' ]
