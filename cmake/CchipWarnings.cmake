# SPDX-License-Identifier: Apache-2.0
# Warning flags of our own code (not of generated models), as a target to link privately. Warnings are errors for those
# who develop this project, which they build with simulation and tests; a packager's newer compiler may warn of more.
# Inside another project its flags reach our sources: what they warn of is not that project's to mend, so nothing is said.
add_library(cchip_warnings INTERFACE)
if(PROJECT_IS_TOP_LEVEL AND CCHIP_SIMULATION AND BUILD_TESTING)
  set(own_build ON)
else()
  set(own_build OFF)
endif()
option(CCHIP_WERROR "Warnings in our own code are errors" ${own_build})
if(PROJECT_IS_TOP_LEVEL OR CCHIP_WERROR)
  target_compile_options(cchip_warnings INTERFACE
    $<$<CXX_COMPILER_ID:MSVC>:/W4>
    $<$<NOT:$<CXX_COMPILER_ID:MSVC>>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion>
    $<$<BOOL:${CCHIP_WERROR}>:$<IF:$<CXX_COMPILER_ID:MSVC>,/WX,-Werror>>
    # options of some files that only GCC knows
    $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wno-unknown-warning-option>)
else()
  target_compile_options(cchip_warnings INTERFACE -w)
endif()
# On ARM, GCC notes that C++17 passes a pair of doubles unlike C++14 before GCC 10; no switch of -w silences that.
target_compile_options(cchip_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
if(CCHIP_FUZZ)
  # Traced comparisons find keywords, as tests/fuzz/words do, and halve the speed: every check of UBSan is one.
  add_compile_options(-fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp)
endif()
if(CCHIP_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
