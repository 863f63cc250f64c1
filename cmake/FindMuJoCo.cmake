# Finds MuJoCo 4.0.1 or a later 4 as target mujoco::mujoco: in MUJOCO_ROOT, else in .deps (where setup.sh puts it), else on the system.
# The Python wheel, our usual source, has a versioned library only and no CMake files, hence the glob.
if(MUJOCO_ROOT)
  set(mujoco_places ${MUJOCO_ROOT})
else()
  set(mujoco_places ${PROJECT_SOURCE_DIR}/.deps/mujoco-4.0.1 /usr/local /usr)
endif()

# NO_CACHE: another MUJOCO_ROOT must count the next time we configure.
unset(MuJoCo_INCLUDE_DIR)
unset(MuJoCo_LIBRARY)
foreach(place IN LISTS mujoco_places)
  find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h HINTS ${place}/include ${place} NO_DEFAULT_PATH NO_CACHE)
  file(GLOB candidates ${place}/libmujoco.so* ${place}/lib/libmujoco.so* ${place}/lib64/libmujoco.so*
       ${place}/lib/${CMAKE_LIBRARY_ARCHITECTURE}/libmujoco.so*)
  if(MuJoCo_INCLUDE_DIR AND candidates)
    list(SORT candidates COMPARE NATURAL ORDER DESCENDING)
    list(GET candidates 0 MuJoCo_LIBRARY)
    break()
  endif()
  unset(MuJoCo_INCLUDE_DIR)
endforeach()

if(MuJoCo_INCLUDE_DIR)
  file(STRINGS ${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h line REGEX "#define mjVERSION_HEADER +[0-9]+")
  string(REGEX REPLACE ".*mjVERSION_HEADER +([0-9]+).*" "\\1" number "${line}")
  math(EXPR major "${number} / 1000000") # 4.0.0 is 4000000
  math(EXPR minor "${number} / 1000 % 1000")
  math(EXPR patch "${number} % 1000")
  set(MuJoCo_VERSION ${major}.${minor}.${patch})
  if(NOT major EQUAL 4)
    message(FATAL_ERROR "Encounter needs MuJoCo 4, but ${MuJoCo_INCLUDE_DIR}/mujoco has mjVERSION_HEADER ${number}. "
                        "Point MUJOCO_ROOT (or the variable ENCOUNTER_MUJOCO of ./encounter) to a MuJoCo 4.")
  endif()
  if(MuJoCo_VERSION VERSION_LESS 4.0.1)
    message(FATAL_ERROR "${MuJoCo_INCLUDE_DIR}/mujoco is MuJoCo 4.0.0, whose solver factors a wrong Hessian where the "
                        "constraint Jacobian is sparse (mended in 4.0.1). Point MUJOCO_ROOT (or the variable "
                        "ENCOUNTER_MUJOCO of ./encounter) to a later one.")
  endif()
endif()

list(JOIN mujoco_places ", " looked_in)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  MuJoCo
  REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR
  VERSION_VAR MuJoCo_VERSION
  REASON_FAILURE_MESSAGE "Looked in ${looked_in}. ./encounter fetches it, MUJOCO_ROOT names another place.")

if(MuJoCo_FOUND AND NOT TARGET mujoco::mujoco)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(
    mujoco::mujoco PROPERTIES IMPORTED_LOCATION ${MuJoCo_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${MuJoCo_INCLUDE_DIR})
endif()
