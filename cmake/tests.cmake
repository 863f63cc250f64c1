# Tests: one program per folder, and `heavy`, the slow part of unit and input; linked with the libraries that it tests.
# ctest runs a program as a few shards, each one process: hundreds of processes would spend their time in starting. What
# takes minutes is in suites called *Long.
# The support library always has a source, because it owns the precompiled header that all test programs share.
file(CONFIGURE OUTPUT ${generated}/pch.cpp CONTENT "// Here the precompiled header is made.\n")
file(GLOB sources CONFIGURE_DEPENDS tests/support/*.cpp)
if(ENCOUNTER_VISION)
  file(GLOB vision CONFIGURE_DEPENDS tests/support/vision/*.cpp)
  list(APPEND sources ${vision})
endif()
add_library(enc_test_support STATIC ${generated}/pch.cpp ${sources})
target_link_libraries(enc_test_support PUBLIC enc_app enc_fit enc_forcedimension enc_gcs enc_hand enc_igtl enc_leap enc_net enc_netft enc_phantom enc_trial GTest::gmock GTest::gtest)
foreach(part enc_gripper enc_vision enc_camera enc_images enc_v4l2 enc_picture enc_calibration)
  if(TARGET ${part})
    target_link_libraries(enc_test_support PUBLIC ${part})
  endif()
endforeach()
# The only file of the tests that knows a path, so that a compiler cache knows all others in another folder, too.
set_source_files_properties(
  tests/support/built.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_DEFINITIONS
  "ENCOUNTER_MODULE_DIR=\"${module_dir}\";ENCOUNTER_BINARY=\"${PROJECT_BINARY_DIR}/encounter\";ENCOUNTER_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\"")
# g++ takes a precompiled header only where -fPIC and -fPIE are the same; CMake gives libraries one, programs the other.
set_target_properties(enc_test_support PROPERTIES POSITION_INDEPENDENT_CODE OFF)
# Tests are compiled for a short build. What they link is optimised as ever, but for inline functions of headers.
target_compile_options(enc_test_support PUBLIC $<IF:$<CONFIG:Release>,-O1,-Og>)
enc_precompile(enc_test_support ${enc_standard_headers} ${enc_eigen_headers} <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h>)

find_path(CGAL_INCLUDE_DIR CGAL/AABB_tree.h)
find_path(MPFR_INCLUDE_DIR mpfr.h)
find_library(MPFR_LIBRARY mpfr)
find_library(GMP_LIBRARY gmp)
find_path(OPENIGTLINK_INCLUDE_DIR igtlTransformMessage.h PATH_SUFFIXES openigtlink)
find_library(OPENIGTLINK_LIBRARY OpenIGTLink)

# Each test is built and run where it finds most, so that no check builds all twice: what parses, decides and frees, under
# ASan and UBSan (preset dev); what draws, runs whole scenes, measures or keeps both cores busy, optimised (release);
# golden and fuzz in both, as heap is counted where no sanitizer does it; threads under ThreadSanitizer (tsan).
# `./check --full` runs all of them in both.
add_custom_target(tests_sanitized) # what `./check` builds in dev
add_custom_target(tests_optimised) # and in release
set(sanitized unit input fuzz golden conformance)
set(optimised heavy property golden fuzz benchmarks hygiene shape terminal)
# Of tests/unit and tests/input: what draws pictures by the thousand, runs whole scenes, or follows a mass through 10^8
# periods. Under ASan they take 10 to 30 times as long, four fifths of all the time there. A new test that takes a second
# in release belongs here.
set(draws
    unit/app/view/ unit/core/shape/deformation/ unit/core/vision/augment/ unit/core/vision/ball/ unit/core/vision/finger/
    unit/core/vision/hand/ unit/core/vision/segmentation/[a-z_]*_test unit/core/vision/stereo/match unit/core/vision/tracker_test
    unit/models/identify/stereo/ unit/sim/camera/ unit/trial/camera/faulty unit/trial/identify/camera/
    input/app/calibrate/images/ input/app/camera/ input/app/camera_test)
set(runs_scenes
    unit/core/machine/motors unit/core/control/stages/edge unit/models/built_scene unit/sim/arm_world unit/sim/legs
    unit/trial/identify/ball/ unit/trial/identify/rig/ unit/trial/identify/shadow/ unit/trial/measure/ unit/trial/whole_run
    input/app/calibrate/calibrate_rig
    input/app/calibrate/calibrate_tracker input/app/calibrate/calibrate_camera input/app/check_test input/app/limits_input input/app/rig_test input/app/scenes/ input/app/shadow_input
    input/app/stop_test input/app/sweep/ input/app/verdict_input)
set(long_loops unit/core/control/safety/certificate/)
set(slow ${draws} ${runs_scenes} ${long_loops})
list(TRANSFORM slow PREPEND "/tests/")
list(JOIN slow "|" slow)
set(needs_vision "/tests/.*(/(vision|images|v4l2)/|/(app|benchmarks|sim|trial)/camera/|camera_test)") # what is not built without it

function(enc_test kind shards) # enc_test(folder shards libraries...); heavy: of unit and input, as above
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS tests/${kind}/*.cpp)
  if(kind STREQUAL "heavy")
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS tests/input/*.cpp tests/unit/*.cpp)
    list(FILTER sources INCLUDE REGEX "${slow}")
    list(APPEND sources ${PROJECT_SOURCE_DIR}/tests/input/app/program.cpp ${PROJECT_SOURCE_DIR}/tests/unit/trial/runs.cpp)
  elseif(kind MATCHES "unit|input")
    list(FILTER sources EXCLUDE REGEX "${slow}")
  endif()
  list(FILTER sources EXCLUDE REGEX "fuzz/coverage/|/preload/") # below
  if(NOT CGAL_INCLUDE_DIR) # headers only, of the tests alone
    list(FILTER sources EXCLUDE REGEX mesh_property_test)
  endif()
  if(NOT MPFR_INCLUDE_DIR OR NOT MPFR_LIBRARY)
    list(FILTER sources EXCLUDE REGEX math_test)
  endif()
  if(NOT OPENIGTLINK_INCLUDE_DIR OR NOT OPENIGTLINK_LIBRARY)
    list(FILTER sources EXCLUDE REGEX igtl_foreign_test)
  endif()
  if(NOT TARGET enc_gripper)
    list(FILTER sources EXCLUDE REGEX "gripper_test|targets/modbus")
  endif()
  if(NOT ENCOUNTER_VISION)
    list(FILTER sources EXCLUDE REGEX "${needs_vision}")
  endif()
  if(NOT TARGET enc_picture)
    list(FILTER sources EXCLUDE REGEX "/tests/.*/picture/")
  endif()
  if(NOT TARGET enc_calibration)
    list(FILTER sources EXCLUDE REGEX "/tests/.*/(calibrate/images|identify/stereo)/")
  endif()
  if(NOT TARGET enc_camera)
    list(FILTER sources EXCLUDE REGEX "/tests/.*(/(app|benchmarks|sim|trial)/camera/|faulty_camera_test)")
  endif()
  if(NOT sources)
    return()
  endif()
  enc_program(test_${kind} ${sources})
  if(kind STREQUAL "threads") # of what has threads and of nothing else: ThreadSanitizer has a third to build
    target_link_libraries(test_${kind} PRIVATE ${ARGN} GTest::gmock GTest::gtest GTest::gtest_main)
  else()
    target_link_libraries(test_${kind} PRIVATE enc_test_support ${ARGN} GTest::gtest_main)
    enc_precompile_as(test_${kind} enc_test_support)
    set_target_properties(test_${kind} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  endif()
  set(folders)
  foreach(source IN LISTS sources)
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    cmake_path(GET source PARENT_PATH folder)
    list(APPEND folders ${folder})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  # Where two helpers of a folder share a name, the call in the one may silently take the other.
  enc_batches(test_${kind} "${folders}")
  if(kind STREQUAL "benchmarks")
    add_dependencies(test_${kind} program bench)
  elseif(NOT kind STREQUAL "threads") # which starts no program and loads no module
    add_dependencies(test_${kind} program fit view vision calibration)
  endif()
  if(kind STREQUAL "hygiene")
    add_dependencies(test_${kind} examples encounter_core encounter_kit)
  endif()
  set(labels ${kind})
  foreach(group sanitized optimised)
    if(kind IN_LIST ${group})
      add_dependencies(tests_${group} test_${kind})
      list(APPEND labels ${group})
    endif()
  endforeach()
  set(timeout 600)
  if(kind STREQUAL "heavy" AND ENCOUNTER_SANITIZE)
    set(timeout 7200)
  endif()
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${kind}.${shard} COMMAND test_${kind} --gtest_brief=1 --gtest_filter=-*Long.*)
    set_tests_properties(${kind}.${shard} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout} ENVIRONMENT
                         "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
    if(kind STREQUAL "conformance") # one long run that waits for sockets: first, so that others run beside it
      set_tests_properties(${kind}.${shard} PROPERTIES COST 1000)
    endif()
    if(kind MATCHES "shape|threads|terminal") # these look at the clock; a busy kernel delivers keys seconds late
      set_tests_properties(${kind}.${shard} PROPERTIES RUN_SERIAL TRUE)
    endif()
  endforeach()
  foreach(source IN LISTS sources)
    file(STRINGS ${source} found REGEX "^TEST.*Long, ")
    if(found)
      add_test(NAME ${kind}.long COMMAND test_${kind} --gtest_brief=1 --gtest_filter=*Long.*)
      set_tests_properties(${kind}.long PROPERTIES LABELS long TIMEOUT 3600)
      break()
    endif()
  endforeach()
endfunction()

enc_test(unit 4)
enc_test(heavy 6)
enc_test(property 4)
if(MPFR_INCLUDE_DIR AND MPFR_LIBRARY)
  target_link_libraries(test_property PRIVATE ${MPFR_LIBRARY} ${GMP_LIBRARY})
endif()
enc_test(golden 2)
enc_test(conformance 1)
if(OPENIGTLINK_INCLUDE_DIR AND OPENIGTLINK_LIBRARY)
  target_include_directories(test_conformance SYSTEM PRIVATE ${OPENIGTLINK_INCLUDE_DIR})
  target_link_libraries(test_conformance PRIVATE ${OPENIGTLINK_LIBRARY})
endif()
if(TARGET enc_v4l2) # for a foreign program, which has no sanitizer
  add_library(video_preload MODULE tests/conformance/v4l2/preload/video_preload.cpp hw_drivers/v4l2/wire/relay.cpp hw_drivers/net/clocks.cpp)
  target_include_directories(video_preload PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_options(video_preload PRIVATE -fno-sanitize=all)
  target_link_options(video_preload PRIVATE -fno-sanitize=all)
  target_link_libraries(video_preload PRIVATE Eigen3::Eigen fmt::fmt ${CMAKE_DL_LIBS})
  set_target_properties(video_preload PROPERTIES PREFIX "" UNITY_BUILD OFF)
  add_dependencies(test_conformance video_preload)
endif()
enc_test(terminal 2) # a person at the terminal of an armed run
enc_test(benchmarks 2 $<LINK_LIBRARY:WHOLE_ARCHIVE,enc_bench>)
enc_test(input 4)
enc_test(shape 1)
enc_test(hygiene 2)
# Where the kernel lets nobody count system calls, the list of tests says so.
add_test(NAME hygiene.system_calls COMMAND test_hygiene --gtest_filter=SystemCalls.*)
set_tests_properties(hygiene.system_calls PROPERTIES LABELS "hygiene;optimised" TIMEOUT 60 SKIP_REGULAR_EXPRESSION "SKIPPED")
# The Python package beside the program, with Debian's numpy.
find_program(DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(DEBIAN_PYTHON AND NOT ENCOUNTER_SANITIZE)
  add_test(NAME python COMMAND ${DEBIAN_PYTHON} -B ${PROJECT_SOURCE_DIR}/tests/python/encounter_test.py)
  set_tests_properties(python PROPERTIES LABELS "python;optimised" TIMEOUT 300 ENVIRONMENT
    "ENCOUNTER_PROGRAM=${PROJECT_BINARY_DIR}/encounter;ENCOUNTER_MODELS=${PROJECT_SOURCE_DIR}/models;PYTHONPATH=${PROJECT_SOURCE_DIR}/python")
  add_dependencies(tests_optimised program)
endif()
enc_test(fuzz 4)
if(ENCOUNTER_VISION)
  enc_test(threads 1 enc_trackers enc_arm enc_gcs enc_igtl enc_netft enc_vision)
  target_sources(test_threads PRIVATE tests/unit/core/vision/finger/drawn_hand.cpp)
else()
  enc_test(threads 1 enc_trackers enc_arm enc_gcs enc_igtl enc_netft)
endif()
# Lines of devices are made printable; of enc_models nothing else is needed.
target_sources(test_threads PRIVATE models/schema/printable.cpp)

# The targets of tests/fuzz under libFuzzer, which clang alone has: preset `fuzz`, docs/reference/fuzz.md.
if(ENCOUNTER_SANITIZE MATCHES "fuzzer")
  file(GLOB sources CONFIGURE_DEPENDS tests/fuzz/coverage/*.cpp tests/fuzz/machine/*.cpp tests/fuzz/targets/*.cpp)
  if(TARGET enc_images)
    file(GLOB images CONFIGURE_DEPENDS tests/fuzz/images/*.cpp)
    list(APPEND sources ${images})
  endif()
  enc_program(fuzz ${sources} tests/support/built.cpp tests/support/scenes.cpp)
  target_link_libraries(fuzz PRIVATE enc_fit enc_gcs enc_hand enc_igtl enc_netft enc_trial $<$<TARGET_EXISTS:enc_gripper>:enc_gripper> $<$<TARGET_EXISTS:enc_images>:enc_images> fmt::fmt)
  target_link_options(fuzz PRIVATE -fsanitize=fuzzer)
endif()
