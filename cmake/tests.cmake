# Tests: one program per folder, linked with the libraries that it tests. ctest runs a program as a few shards, each one
# process: hundreds of processes would spend their time in starting. What takes minutes is in suites called *Long.
# The support library always has a source, because it owns the precompiled header that all test programs share.
file(CONFIGURE OUTPUT ${generated}/pch.cpp CONTENT "// Here the precompiled header is made.\n")
file(GLOB sources CONFIGURE_DEPENDS tests/support/*.cpp)
add_library(enc_test_support STATIC ${generated}/pch.cpp ${sources})
target_link_libraries(enc_test_support PUBLIC enc_app enc_fit enc_trial GTest::gmock GTest::gtest)
target_compile_definitions(enc_test_support PUBLIC ENCOUNTER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_source_files_properties(
  tests/support/built.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_DEFINITIONS
  "ENCOUNTER_MODULE_DIR=\"${module_dir}\";ENCOUNTER_BINARY=\"${PROJECT_BINARY_DIR}/encounter\"")
# g++ takes a precompiled header only where -fPIC and -fPIE are the same; CMake gives libraries one, programs the other.
set_target_properties(enc_test_support PROPERTIES POSITION_INDEPENDENT_CODE OFF)
enc_precompile(enc_test_support ${enc_standard_headers} ${enc_eigen_headers} <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h>)

find_path(CGAL_INCLUDE_DIR CGAL/AABB_tree.h)

add_custom_target(tests) # all but those of the benchmarks
function(enc_test kind shards) # enc_test(folder shards libraries...)
  file(GLOB sources CONFIGURE_DEPENDS tests/${kind}/*.cpp)
  if(NOT CGAL_INCLUDE_DIR) # headers only, of the tests alone
    list(FILTER sources EXCLUDE REGEX mesh_property_test)
  endif()
  if(NOT sources)
    return()
  endif()
  add_executable(test_${kind} ${sources})
  target_link_libraries(test_${kind} PRIVATE enc_test_support ${ARGN} GTest::gtest_main)
  enc_precompile_as(test_${kind} enc_test_support)
  set_target_properties(test_${kind} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  if(kind STREQUAL "benchmarks")
    add_dependencies(test_${kind} program bench)
  else()
    add_dependencies(test_${kind} program fit view)
    add_dependencies(tests test_${kind})
  endif()
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${kind}.${shard} COMMAND test_${kind} --gtest_brief=1 --gtest_filter=-*Long.*)
    set_tests_properties(${kind}.${shard} PROPERTIES LABELS ${kind} TIMEOUT 600 ENVIRONMENT
                         "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
    if(kind MATCHES "shape|threads") # these look at the clock
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
enc_test(property 4)
enc_test(golden 2)
enc_test(conformance 1)
enc_test(benchmarks 2 enc_bench)
enc_test(input 4)
enc_test(shape 1)
enc_test(threads 1)
