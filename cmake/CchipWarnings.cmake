# SPDX-License-Identifier: Apache-2.0
# Warning flags of our own code (not of generated models), as a target to link privately.
add_library(cchip_warnings INTERFACE)
target_compile_options(cchip_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
  # options of some files that only GCC knows
  $<$<CXX_COMPILER_ID:Clang>:-Wno-unknown-warning-option>)
if(CCHIP_FUZZ)
  # Traced comparisons find keywords, as tests/fuzz/words do, and halve the speed: every check of UBSan is one.
  add_compile_options(-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp)
endif()
if(CCHIP_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
