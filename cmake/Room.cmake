# One helper for every room: groundloop_room(slam_stereo SOURCES a.cpp b.cpp USES slam_types PRIVATE ...)
# The target is named for its folder, headers are included from the root ("slam/stereo/disparity.h").
function(groundloop_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ROOM_SOURCES})
  target_link_libraries(${name} PUBLIC groundloop_base ${ROOM_USES} PRIVATE ${ROOM_PRIVATE})
endfunction()

# groundloop_test(slam_features SOURCES a_test.cpp USES slam_features): one test binary a room, mirrored under tests/.
function(groundloop_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;USES" ${ARGN})
  add_executable(test_${name} ${TEST_SOURCES})
  target_link_libraries(test_${name} PRIVATE groundloop_base ${TEST_USES} GTest::gtest GTest::gmock GTest::gtest_main
    test_temporary_folder)
  # A third of the time to compile them; what they test is optimised as ever.
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  gtest_discover_tests(test_${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 600
    ENVIRONMENT TSAN_OPTIONS=detect_deadlocks=0:suppressions=${PROJECT_SOURCE_DIR}/cmake/races.supp
    ENVIRONMENT_MODIFICATION LSAN_OPTIONS=set:suppressions=${PROJECT_SOURCE_DIR}/cmake/leaks.supp
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} TEST_PREFIX "${name}.")
endfunction()
