# Vision and the cameras that it looks through: modules that nothing but a scene with a camera, or a command, loads. The
# kernels need nothing but the core; OpenCV is behind the module that calibrates.
add_custom_target(vision) # what a scene with a camera needs more
add_custom_target(calibration) # what `./encounter calibrate stereo` and `skin` need more
if(NOT ENCOUNTER_VISION)
  return()
endif()

enc_library(enc_vision "core/vision;core/vision/augment;core/vision/ball;core/vision/finger;core/vision/hand;core/vision/segmentation;core/vision/segmentation/kernels;core/vision/stereo" enc_core)
enc_precompile(enc_vision ${enc_standard_headers} ${enc_eigen_headers})
# Kernels for processors that have AVX2, chosen at run time. They share nothing inline with the rest.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS core/vision/*_avx2.cpp)
set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS "-mavx2;-O3" SKIP_PRECOMPILE_HEADERS ON)
enc_module(vision vision core/vision/module/module.cpp enc_vision)

find_path(EGL_INCLUDE_DIR EGL/egl.h)
if(EGL_INCLUDE_DIR)
  enc_library(enc_camera "sim/camera" enc_sim mujoco::mujoco ${CMAKE_DL_LIBS})
  target_sources(enc_camera PRIVATE sim/view/egl.cpp)
  target_include_directories(enc_camera SYSTEM PRIVATE ${EGL_INCLUDE_DIR})
  enc_precompile_as(enc_camera enc_precompiled)
  enc_module(camera vision sim/camera/module/module.cpp enc_camera)
else()
  message(STATUS "No camera of the twin: the EGL headers are missing (a scene with a camera installs them)")
endif()

find_path(TURBOJPEG_INCLUDE_DIR turbojpeg.h)
find_library(TURBOJPEG_LIBRARY turbojpeg)
if(PNG_FOUND AND TURBOJPEG_INCLUDE_DIR AND TURBOJPEG_LIBRARY)
  enc_library(enc_images "hw_drivers/images/files;hw_drivers/images/play" enc_child enc_core PNG::PNG ${TURBOJPEG_LIBRARY} fmt::fmt)
  file(GLOB sources CONFIGURE_DEPENDS hw_drivers/images/*.cpp)
  if(sources)
    enc_module(images vision "${sources}" enc_images)
  endif()
else()
  message(STATUS "No driver of images: libpng or libturbojpeg is missing (a scene with a camera installs them)")
endif()

find_package(OpenCVParts)
if(OpenCVParts_FOUND AND TARGET enc_images)
  # Private: what links it compiles as without OpenCV, so that `lean` takes its objects from ccache.
  enc_library(enc_calibration "models/identify/stereo" enc_vision)
  target_link_libraries(enc_calibration PRIVATE opencv::parts)
  file(GLOB sources CONFIGURE_DEPENDS app/calibrate/images/*.cpp)
  if(sources)
    enc_module(calibration calibration "${sources}" enc_calibration enc_vision enc_images enc_picture enc_models nlohmann_json::nlohmann_json)
    enc_batches(encounter_calibration app/calibrate/images)
  endif()
endif()
