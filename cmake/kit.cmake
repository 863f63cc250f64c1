# The door for a benchmark of somebody else: `find_package(Encounter COMPONENTS benchmark)` gives encounter_benchmark()
# (cmake/EncounterBenchmark.cmake). It is installed with the program once `bench` is built, or without the program:
#   cmake --install build/release --prefix DIR --component core, and again with --component benchmark
add_library(encounter_kit STATIC $<TARGET_OBJECTS:enc_models> $<TARGET_OBJECTS:enc_sim> $<TARGET_OBJECTS:enc_trackers>
            $<TARGET_OBJECTS:enc_trial> $<TARGET_OBJECTS:enc_child> $<TARGET_OBJECTS:enc_kit> $<TARGET_OBJECTS:enc_commit>)
set_target_properties(encounter_kit PROPERTIES EXPORT_NAME kit LINKER_LANGUAGE CXX)
target_link_libraries(encounter_kit INTERFACE encounter_core fmt::fmt tomlplusplus::tomlplusplus TinyGLTF::TinyGLTF
                      $<BUILD_INTERFACE:mujoco::mujoco> $<INSTALL_INTERFACE:Encounter::mujoco>)
# Nine tenths of it would be line numbers.
add_custom_command(TARGET encounter_kit POST_BUILD COMMAND ${CMAKE_STRIP} --strip-debug $<TARGET_FILE:encounter_kit> VERBATIM)
add_dependencies(bench encounter_kit)

install(TARGETS encounter_kit EXPORT EncounterKitTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT benchmark OPTIONAL)
install(EXPORT EncounterKitTargets NAMESPACE Encounter:: DESTINATION ${package_dir} COMPONENT benchmark)
install(FILES cmake/EncounterBenchmark.cmake DESTINATION ${package_dir} COMPONENT benchmark)
install(DIRECTORY models sim trial DESTINATION include/encounter COMPONENT benchmark FILES_MATCHING PATTERN "*.h"
        REGEX "/(models/(identify|mjcf|questionnaires|responses|rigs|scenes)|sim/(picture|view|window)|trial/(camera|identify))$" EXCLUDE)
install(DIRECTORY benchmarks/kit DESTINATION include/encounter/benchmarks COMPONENT benchmark FILES_MATCHING PATTERN "*.h"
        PATTERN "module.cpp")
get_target_property(mujoco_headers mujoco::mujoco INTERFACE_INCLUDE_DIRECTORIES)
install(DIRECTORY ${mujoco_headers}/mujoco DESTINATION include/encounter COMPONENT benchmark)
