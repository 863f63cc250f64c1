# How everything is compiled: the same flags for every target, because inline functions of core's headers are compiled
# into all of them and the linker keeps any one copy.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

# -g1: lines in backtraces and profiles at little cost.
# A section for each function, so that the linker leaves out what nothing calls.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG -g1 -ffunction-sections -fdata-sections")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1 -D_GLIBCXX_ASSERTIONS") # -g builds a third longer; -O0 shorter, but its tests take ten times as long

# A replay gives the same bits on every machine (core/math/README.md): no fused multiply-add, never -ffast-math, never
# -march. The two others change no result; they only say that nobody reads errno or traps.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)

# -Wfloat-conversion rather than all of -Wconversion, which with Eigen's indices says too much.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wfloat-conversion -Wnon-virtual-dtor -Woverloaded-virtual
                    -Wold-style-cast -Wcast-qual -Wvla -Wundef)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  if(ENCOUNTER_FAST_BUILD) # it collects its garbage from half a gigabyte on: a twelfth less time
    add_compile_options(--param=ggc-min-heapsize=524288)
  endif()
  # Those that are off see ghosts in std::string, where a precompiled header hides that it is the system's.
  add_compile_options(-Wduplicated-cond -Wlogical-op -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options(-Wno-return-type-c-linkage) # OpenHaptics returns a struct by value, which C can read
endif()
# Only with the compilers we test with: a newer one has new warnings, which must not keep a newcomer from building.
set(tested_GNU 13)
set(tested_Clang 15)
if(ENCOUNTER_WERROR AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS "${tested_${CMAKE_CXX_COMPILER_ID}}")
  add_compile_options(-Werror)
endif()

if(ENCOUNTER_SANITIZE)
  add_compile_options(-fsanitize=${ENCOUNTER_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ENCOUNTER_SANITIZE})
  # Checks of every pointer that is followed double the time to compile; ./check --full has them. AddressSanitizer stops
  # most of what they find.
  if(ENCOUNTER_SANITIZE MATCHES "undefined" AND NOT ENCOUNTER_EVERY_POINTER)
    add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
  endif()
  add_compile_options(-Wno-maybe-uninitialized) # g++ 12 warns of its own instrumentation
endif()

# Nothing undefined in a module, so that a missing function shows when linking and not on somebody's machine.
add_link_options(-Wl,--as-needed $<$<CONFIG:Release>:-Wl,--gc-sections>)
set(CMAKE_MODULE_LINKER_FLAGS "-Wl,--no-undefined")
