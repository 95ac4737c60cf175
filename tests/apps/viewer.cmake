# hoist_viewer on a virtual display (Xvfb, xdotool) and without one.
hoist_add_test(test_viewer_parts SOURCES test_viewer_parts.cpp
  LIBRARIES hoist_viewer_parts)
foreach(group Usage Headless Window RealFrames)
  add_test(NAME viewer.${group}
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/test_viewer.py ${group})
  set_tests_properties(viewer.${group} PROPERTIES
    TIMEOUT ${HOIST_TEST_TIMEOUT}
    SKIP_REGULAR_EXPRESSION "HOIST_REAL_DATA is not set|is not installed"
    ENVIRONMENT "HOIST_VIEWER=$<TARGET_FILE:hoist_viewer>;HOIST_PROGRAM=$<TARGET_FILE:hoist>;HOIST_SAMPLES=${PROJECT_SOURCE_DIR}/data/samples")
endforeach()
