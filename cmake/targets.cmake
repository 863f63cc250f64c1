# How a library, a module and a precompiled header are made. What a project lists more than once stands here once.

# A library of all sources of some folders but main.cpp and module.cpp; without sources it still passes on what it would link.
function(enc_library name folders) # enc_library(name "folder;folder/part" libraries...)
  list(TRANSFORM folders APPEND /*.cpp OUTPUT_VARIABLE patterns)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  list(FILTER sources EXCLUDE REGEX "/(main|module)\\.cpp$")
  if(sources)
    add_library(${name} STATIC ${sources})
    enc_batches(${name} "${folders}")
    target_link_libraries(${name} PUBLIC ${ARGN})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARGN})
  endif()
endfunction()

# A program, with the elementary functions of core/math in place of libm's.
function(enc_program name) # enc_program(name sources...)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE enc_math)
  target_link_options(${name} PRIVATE LINKER:--dynamic-list=${PROJECT_SOURCE_DIR}/core/math/export.list)
  set_target_properties(${name} PROPERTIES LINK_DEPENDS ${PROJECT_SOURCE_DIR}/core/math/export.list)
endfunction()

set(module_dir ${PROJECT_BINARY_DIR}/modules)
function(enc_module name group sources) # enc_module(name target "sources" libraries...)
  add_library(encounter_${name} MODULE ${sources})
  target_link_libraries(encounter_${name} PRIVATE ${ARGN} fmt::fmt) # which the precompiled header wants; left out where unused
  set_target_properties(encounter_${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${module_dir})
  enc_precompile_as(encounter_${name} enc_precompiled)
  add_dependencies(${group} encounter_${name})
  set_property(GLOBAL APPEND PROPERTY enc_modules encounter_${name})
endfunction()

# A stand-in for a vendor's library, lib<NAME>.so in the folder `fakes` beside the modules, where the vendor's is loaded by name.
function(enc_vendor_fake name source) # enc_vendor_fake(NAME source libraries...)
  add_library(encounter_fake_${name} SHARED ${source})
  target_link_libraries(encounter_fake_${name} PRIVATE ${ARGN})
  set_target_properties(encounter_fake_${name} PROPERTIES OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${module_dir}/fakes)
  add_dependencies(program encounter_fake_${name})
  set_property(GLOBAL APPEND PROPERTY enc_vendor_fakes encounter_fake_${name})
endfunction()

# Headers that are not ours, compiled once for a library: the front end spends most of its time in them. Sources still
# include what they use, so each also compiles alone.
set(enc_standard_headers
    <algorithm> <array> <bit> <charconv> <cmath> <cstddef> <cstdint> <cstdio> <cstring> <filesystem> <fstream> <functional>
    <limits> <map> <memory> <numbers> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view>
    <type_traits> <utility> <variant> <vector>)
set(enc_eigen_headers <Eigen/Core> <Eigen/Geometry>)

function(enc_precompile name)
  if(ENCOUNTER_FAST_BUILD)
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

# The same as another library's, which is compiled with the same flags.
function(enc_precompile_as name other)
  if(ENCOUNTER_FAST_BUILD)
    target_precompile_headers(${name} REUSE_FROM ${other})
  endif()
endfunction()

# Files of one folder are compiled together, which takes half the time or less: they include the same headers. So what is in
# their anonymous namespaces has names of its own within the folder (tests/shape/functions_test.cpp). Each also compiles alone.
function(enc_batches name folders) # enc_batches(name "folder;folder")
  if(ENCOUNTER_FAST_BUILD)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    foreach(folder IN LISTS folders)
      file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
      string(REPLACE "/" "_" group ${folder})
      set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
    endforeach()
  endif()
endfunction()
