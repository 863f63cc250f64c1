# find_package(Encounter): the haptic core, and modules for an installed program.
#   Encounter::core                        a library with its headers: #include "core/control/step.h"
#   encounter_driver(name sources...)      encounter_name.so, a driver that `driver = "name"` in a rig file loads.
#                                          Copy it to bin/modules/. Where ENCOUNTER_MODULES names a folder, the program
#                                          looks for all drivers there.
# With COMPONENTS benchmark, of a whole Encounter:
#   encounter_benchmark(name sources...)   a benchmark that `encounter bench name` runs (EncounterBenchmark.cmake).
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/EncounterTargets.cmake)

function(encounter_driver name)
  add_library(encounter_${name} MODULE ${ARGN})
  target_link_libraries(encounter_${name} PRIVATE Encounter::core)
  set_target_properties(encounter_${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

if("benchmark" IN_LIST Encounter_FIND_COMPONENTS)
  include(${CMAKE_CURRENT_LIST_DIR}/EncounterBenchmark.cmake OPTIONAL RESULT_VARIABLE has_kit)
  if(NOT has_kit)
    set(Encounter_NOT_FOUND_MESSAGE "${CMAKE_CURRENT_LIST_DIR} is of the core alone; install the whole of Encounter.")
  endif()
  if(Encounter_FIND_REQUIRED_benchmark AND NOT Encounter_benchmark_FOUND)
    set(Encounter_FOUND FALSE)
  endif()
endif()
