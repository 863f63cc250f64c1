# `cmake --install build/release --prefix DIR` gives a folder that runs anywhere on a machine with the same packages:
#   bin/encounter  bin/modules/  lib/ (MuJoCo)  models/  benchmarks/reference/  share/ (manual page, completion);
#   and the core and the kit for others (package.cmake, kit.cmake)
# What was not built (a view without ./encounter view) is not missed.
install(TARGETS encounter RUNTIME DESTINATION bin)
get_property(modules GLOBAL PROPERTY enc_modules)
install(TARGETS ${modules} LIBRARY DESTINATION bin/modules OPTIONAL)
get_property(vendor_fakes GLOBAL PROPERTY enc_vendor_fakes)
install(TARGETS ${vendor_fakes} LIBRARY DESTINATION bin/modules/fakes OPTIONAL)

# One run path for here and there: beside the program, else where MuJoCo was found. CMake's own way would pad it with an
# empty entry, and that means: whatever folder one stands in.
get_target_property(mujoco_library mujoco::mujoco IMPORTED_LOCATION)
file(REAL_PATH ${mujoco_library} mujoco_library)
cmake_path(GET mujoco_library PARENT_PATH mujoco_folder)
set_target_properties(encounter ${modules} PROPERTIES BUILD_WITH_INSTALL_RPATH ON)
set_target_properties(encounter PROPERTIES INSTALL_RPATH "$ORIGIN/../lib;${mujoco_folder}")
set_target_properties(${modules} PROPERTIES INSTALL_RPATH "$ORIGIN/../../lib;${mujoco_folder}")

install(FILES ${mujoco_library} DESTINATION lib COMPONENT benchmark) # a benchmark of somebody else links it, too
file(GLOB licences ${mujoco_folder}/../LICENSE*)
install(FILES ${licences} DESTINATION lib COMPONENT benchmark)
install(DIRECTORY models/ DESTINATION models FILES_MATCHING PATTERN "*.toml" PATTERN "*.xml" PATTERN "*.glb" PATTERN "*.obj"
        PATTERN "*.stl" PATTERN "*.csv" REGEX "/models/(directions|identify|mesh_files|schema|setup|shapes|sizes|tables)$" EXCLUDE) # code
install(DIRECTORY benchmarks/reference/ DESTINATION benchmarks/reference)
install(FILES LICENSE DESTINATION .)

# The program itself writes its manual page and its completion for bash, from the table behind --help.
install(CODE [[
  function(write_help folder name option)
    set(file "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/${folder}/${name}")
    message(STATUS "Installing: ${file}")
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND "$<TARGET_FILE:encounter>" help ${option} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
  endfunction()
  write_help(man/man1 encounter.1 --man)
  write_help(bash-completion/completions encounter --bash)
]])
