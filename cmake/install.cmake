# `cmake --install build/release --prefix DIR` gives a folder that runs anywhere on a machine with the same packages:
#   bin/encounter  bin/modules/  lib/ (MuJoCo)  models/  benchmarks/reference/
get_target_property(mujoco_library mujoco::mujoco IMPORTED_LOCATION)
set_target_properties(encounter PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")
install(TARGETS encounter RUNTIME DESTINATION bin)
get_property(modules GLOBAL PROPERTY enc_modules)
foreach(module IN LISTS modules)
  set_target_properties(${module} PROPERTIES INSTALL_RPATH "$ORIGIN/../../lib")
  # What was not built (a view without ./encounter view) is not missed.
  install(TARGETS ${module} LIBRARY DESTINATION bin/modules OPTIONAL)
endforeach()
install(FILES ${mujoco_library} DESTINATION lib)
install(DIRECTORY models/ DESTINATION models FILES_MATCHING PATTERN "*.toml" PATTERN "*.xml" PATTERN "*.glb" PATTERN "*.obj"
        PATTERN "*.stl" PATTERN "*.csv")
install(DIRECTORY benchmarks/reference/ DESTINATION benchmarks/reference)
install(FILES LICENSE README.md DESTINATION .)
