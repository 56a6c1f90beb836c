# Debian 13 and later: the CMake files of paraview-dev name ParaView's Python modules without the suffix of Python's ABI,
# so that find_package(ParaView) ends with an error about files that do not exist. Nobody links these modules.

# tyndall_mend_paraview(): where that is so, lets ParaView_DIR be a copy of these CMake files below the build tree, in
# which modules that are not there are no error.
function (tyndall_mend_paraview)
  file(GLOB found "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/paraview-*/ParaViewPython-targets.cmake")
  if (NOT found OR (ParaView_DIR AND NOT ParaView_DIR MATCHES "^${CMAKE_BINARY_DIR}|^/usr/lib/"))
    return () # another ParaView is wanted
  endif ()
  list(GET found -1 found)
  get_filename_component(host "${found}" DIRECTORY)
  file(GLOB targets "${host}/ParaViewPython-targets-*.cmake")
  file(STRINGS "${targets}" module REGEX "_check_files_for_.*/lib/python" LIMIT_COUNT 1)
  string(REGEX REPLACE ".*{_IMPORT_PREFIX}/([^\"]+)\".*" "/usr/\\1" module "${module}")
  if (NOT module OR EXISTS "${module}")
    return ()
  endif ()
  get_filename_component(name "${host}" NAME)
  set(copy "${CMAKE_BINARY_DIR}/MendedHost/${name}")
  file(COPY "${host}" DESTINATION "${CMAKE_BINARY_DIR}/MendedHost")
  file(GLOB_RECURSE files "${copy}/*.cmake")
  foreach (file IN LISTS files)
    file(READ "${file}" original)
    get_filename_component(folder "${file}" DIRECTORY)
    string(REPLACE "${copy}" "${host}" folder "${folder}") # from which they find headers and libraries
    string(REGEX REPLACE "get_filename_component\\(_IMPORT_PREFIX \"\\\${CMAKE_CURRENT_LIST_FILE}\" [A-Z]+\\)"
      "set(_IMPORT_PREFIX \"${folder}\")" text "${original}")
    string(REPLACE "set(_vtk_module_import_prefix \"\${CMAKE_CURRENT_LIST_DIR}\")"
      "set(_vtk_module_import_prefix \"${folder}\")" text "${text}")
    string(REPLACE "\"\${CMAKE_CURRENT_LIST_DIR}/../" "\"${folder}/../" text "${text}")
    if (file MATCHES "Python[A-Za-z]*-targets")
      string(REPLACE "message(FATAL_ERROR \"The imported target" "message(VERBOSE \"The imported target" text "${text}")
    endif ()
    if (NOT text STREQUAL original)
      file(WRITE "${file}" "${text}")
    endif ()
  endforeach ()
  set(ParaView_DIR "${copy}" CACHE PATH "ParaView's CMake files, mended" FORCE)
endfunction ()
