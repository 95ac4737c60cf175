# hoist_viewer on a virtual display (Xvfb, xdotool) and without one.
hoist_add_test(test_viewer_parts SOURCES test_viewer_parts.cpp
  LIBRARIES hoist_viewer_parts)
foreach(test test_viewer.Usage test_viewer.Headless test_viewer_window.Window
             test_viewer_window.RealFrames test_viewer_layers.Layers
             test_viewer_layers.Colours)
  string(REPLACE "." ";" parts ${test})
  list(GET parts 0 file)
  list(GET parts 1 group)
  add_test(NAME viewer.${group}
    COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/${file}.py ${group})
  set_tests_properties(viewer.${group} PROPERTIES
    TIMEOUT ${HOIST_TEST_TIMEOUT}
    SKIP_REGULAR_EXPRESSION "HOIST_REAL_DATA is not set|is not installed"
    ENVIRONMENT "HOIST_VIEWER=$<TARGET_FILE:hoist_viewer>;HOIST_PROGRAM=$<TARGET_FILE:hoist>;HOIST_SAMPLES=${PROJECT_SOURCE_DIR}/data/samples;HOIST_SANITIZE=${HOIST_SANITIZE};LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/lsan.supp")
endforeach()
target_compile_definitions(test_viewer_parts
  PRIVATE HOIST_SAMPLES_DIR="${PROJECT_SOURCE_DIR}/data/samples")
