# `cpack --config build/release/CPackConfig.cmake -B build` makes encounter_VERSION_amd64.deb of what install.cmake installs, with the
# modules that are built by then. It goes to /opt/encounter; /usr has links to the program, its manual page and its
# completion. Needs dpkg-dev.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME encounter)
set(CPACK_PACKAGE_CONTACT "Encounter <encounter@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Digital twin of encounter-type haptic displays")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /opt/encounter)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${mujoco_folder}) # MuJoCo comes with us
# Loaded only by who draws or plots.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri, libosmesa6, gnuplot-nox")
# Each of these in /usr leads to the file of /opt/encounter.
set(links bin/encounter share/man/man1/encounter.1 share/bash-completion/completions/encounter)
set(make_links "#!/bin/sh\nset -e\n")
set(remove_links "#!/bin/sh\nset -e\n")
foreach(link IN LISTS links)
  cmake_path(GET link PARENT_PATH folder)
  string(APPEND make_links "mkdir -p /usr/${folder}\nln -sf /opt/encounter/${link} /usr/${link}\n")
  string(APPEND remove_links "rm -f /usr/${link}\n")
endforeach()
file(CONFIGURE OUTPUT ${generated}/postinst CONTENT "${make_links}")
file(CONFIGURE OUTPUT ${generated}/prerm CONTENT "${remove_links}")
file(CHMOD ${generated}/postinst ${generated}/prerm FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${generated}/postinst;${generated}/prerm")
include(CPack)
