# The door for other people's code: `find_package(Encounter)` gives Encounter::core, the haptic core with Eigen alone, and
# encounter_driver() (cmake/EncounterConfig.cmake). examples/ uses it. kit.cmake adds encounter_benchmark().
#   cmake --install build/release --prefix DIR                      the program and the core
#   cmake --install build/release --prefix DIR --component core     the core alone
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Encounter)

# With the elementary functions, so that a program outside gets the same bits.
add_library(encounter_core STATIC $<TARGET_OBJECTS:enc_core> $<TARGET_OBJECTS:enc_math>)
add_library(Encounter::core ALIAS encounter_core)
set_target_properties(encounter_core PROPERTIES EXPORT_NAME core LINKER_LANGUAGE CXX)
target_compile_features(encounter_core INTERFACE cxx_std_20)
target_compile_options(encounter_core INTERFACE -ffp-contract=off)
target_link_libraries(encounter_core INTERFACE Eigen3::Eigen)
target_include_directories(encounter_core INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${generated}>
                                                    $<INSTALL_INTERFACE:include/encounter>)

install(TARGETS encounter_core EXPORT EncounterTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT core)
install(EXPORT EncounterTargets NAMESPACE Encounter:: DESTINATION ${package_dir} COMPONENT core)
install(DIRECTORY core DESTINATION include/encounter COMPONENT core FILES_MATCHING PATTERN "*.h" PATTERN "core/vision" EXCLUDE)
install(FILES ${generated}/encounter_version.h ${border} DESTINATION include/encounter COMPONENT core)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/EncounterConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES cmake/EncounterConfig.cmake ${PROJECT_BINARY_DIR}/EncounterConfigVersion.cmake DESTINATION ${package_dir}
        COMPONENT core)
