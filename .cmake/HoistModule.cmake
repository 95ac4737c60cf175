# hoist_add_module(<module> SOURCES ... [PUBLIC ...] [PRIVATE ...] [PKGCONFIG ...])
#
# One library of the suite: hoist_<module>, alias and exported as hoist::<module>,
# hidden visibility with a generated hoist/<module>/export.h, installed headers and a
# relocatable hoist_<module>.pc whose Requires: are the PKGCONFIG names.
include(GenerateExportHeader)
include(CMakePackageConfigHelpers)

function(hoist_target_options target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wpedantic)
  if(HOIST_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${HOIST_SANITIZE}
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${HOIST_SANITIZE})
    if(HOIST_SANITIZE MATCHES "undefined")
      target_compile_options(${target} PRIVATE -fno-sanitize-recover=undefined)
    endif()
  endif()
endfunction()

function(hoist_add_module module)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;PKGCONFIG" ${ARGN})
  set(target hoist_${module})
  add_library(${target} ${ARG_SOURCES})
  add_library(hoist::${module} ALIAS ${target})
  hoist_target_options(${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${module}
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    INSTALL_RPATH "$ORIGIN") # its sisters, wherever the tree is installed
  generate_export_header(${target}
    BASE_NAME hoist_${module}
    EXPORT_FILE_NAME ${CMAKE_CURRENT_BINARY_DIR}/include/hoist/${module}/export.h)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} SYSTEM PUBLIC ${PCL_INCLUDE_DIRS}
                                                     ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})

  install(TARGETS ${target} EXPORT hoist-targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ ${CMAKE_CURRENT_BINARY_DIR}/include/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

  set(HOIST_PC_MODULE ${module})
  # opencv4.pc links every module of OpenCV, VTK's among them: only its headers are
  # taken (Requires.private), and the one library that the headers need
  list(REMOVE_ITEM ARG_PKGCONFIG opencv4)
  file(RELATIVE_PATH HOIST_PC_TO_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
       ${CMAKE_INSTALL_PREFIX})
  list(JOIN ARG_PKGCONFIG " " HOIST_PC_REQUIRES)
  configure_file(${PROJECT_SOURCE_DIR}/.cmake/hoist.pc.in
                 ${CMAKE_CURRENT_BINARY_DIR}/hoist_${module}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hoist_${module}.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
