# Makes each suite of a GoogleTest program one test of ctest, in one process: to start one takes longer than most cases do,
# 0.25 s, and a second where kernels are compiled in it.
# cmake -D PROGRAM=<path> -D FILTER=<of GoogleTest> -D RESULT=<file for ctest> -P SuitesAsTests.cmake
# Cases whose names begin with "Slow" take a minute or more; with "Nightly": they are more of what others test daily.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests "--gtest_filter=${FILTER}" OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " *#[^\n]*" "" lines "${lines}") # types and values of parameters
string(REGEX MATCHALL "[^\n]+" lines "${lines}")
set(tests)
foreach (line IN LISTS lines)
  if (line MATCHES "^([A-Za-z0-9_/]+)\\.$")
    set(suite "${CMAKE_MATCH_1}")
  elseif (line MATCHES "^  (Slow|Nightly)?")
    list(APPEND tests "${suite}.${CMAKE_MATCH_1}")
  endif ()
endforeach ()
list(REMOVE_DUPLICATES tests)

set(text)
foreach (test IN LISTS tests)
  set(filter "${test}*")
  set(labels "kernels")
  set(timeout 900)
  if (test MATCHES "\\.$")
    string(APPEND filter "-*.Slow*:*.Nightly*")
  else ()
    string(APPEND labels ";slow")
  endif ()
  if (test MATCHES "\\.Nightly$")
    string(APPEND labels ";nightly")
    set(timeout 1800)
  endif ()
  string(REGEX REPLACE "\\.$" "" test "${test}")
  string(APPEND text "add_test(\"${test}\" \"${PROGRAM}\" \"--gtest_filter=${filter}\")\n"
    "set_tests_properties(\"${test}\" PROPERTIES LABELS \"${labels}\" TIMEOUT ${timeout} SKIP_RETURN_CODE 125)\n")
endforeach ()
file(WRITE "${RESULT}" "${text}")
