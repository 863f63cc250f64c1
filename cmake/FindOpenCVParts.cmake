# Finds core, imgproc and calib3d of OpenCV 4 as target opencv::parts. Debian's CMake files of OpenCV come with a package
# that brings 188 others, and calib3d's own -dev package brings 147: so its library is the one for running programs, and
# its headers are those that setup.sh unpacks into .deps/opencv-headers.
find_path(OpenCVParts_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
find_path(OpenCVParts_CALIB3D_DIR opencv2/calib3d.hpp HINTS ${PROJECT_SOURCE_DIR}/.deps/opencv-headers PATH_SUFFIXES opencv4)
set(OpenCVParts_LIBRARIES)
foreach(part core imgproc calib3d)
  file(GLOB running /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/libopencv_${part}.so.4??) # no -dev package: no plain .so
  list(TRANSFORM running REPLACE ".*/" "")
  find_library(OpenCVParts_${part}_LIBRARY NAMES opencv_${part} ${running})
  list(APPEND OpenCVParts_LIBRARIES ${OpenCVParts_${part}_LIBRARY})
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OpenCVParts
  REQUIRED_VARS OpenCVParts_INCLUDE_DIR OpenCVParts_CALIB3D_DIR OpenCVParts_core_LIBRARY OpenCVParts_imgproc_LIBRARY
                OpenCVParts_calib3d_LIBRARY
  REASON_FAILURE_MESSAGE "./encounter calibrate stereo FOLDER installs what is missing.")

if(OpenCVParts_FOUND AND NOT TARGET opencv::parts)
  add_library(opencv::parts INTERFACE IMPORTED)
  target_include_directories(opencv::parts SYSTEM INTERFACE ${OpenCVParts_INCLUDE_DIR} ${OpenCVParts_CALIB3D_DIR})
  target_link_libraries(opencv::parts INTERFACE ${OpenCVParts_LIBRARIES})
endif()
