# The classes for Python, and the package around them (Filters/Python/tyndall): for the host's VTK, beside whose Python
# modules (vtkmodules) it is imported.
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
if (CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(python_destination "lib/python3/dist-packages") # where Debian's Python looks
else ()
  set(python_destination "${CMAKE_INSTALL_LIBDIR}/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages")
endif ()
set(TYNDALL_PYTHON_PACKAGES "${CMAKE_BINARY_DIR}/${python_destination}")

vtk_module_wrap_python(
  MODULES ${module}
  TARGET Tyndall::Python
  PYTHON_PACKAGE "tyndall"
  MODULE_DESTINATION "${python_destination}"
  LIBRARY_DESTINATION "${library_destination}"
  CMAKE_DESTINATION "${TYNDALL_CMAKE_DESTINATION}"
  INSTALL_HEADERS OFF
  COMPONENT "python")

set(python_folder "${CMAKE_CURRENT_LIST_DIR}/Python")
set(python_sources tyndall/__init__.py tyndall/solving.py)
set(python_copies)
foreach (file IN LISTS python_sources)
  add_custom_command(OUTPUT "${TYNDALL_PYTHON_PACKAGES}/${file}"
    COMMAND "${CMAKE_COMMAND}" -E copy "${python_folder}/${file}" "${TYNDALL_PYTHON_PACKAGES}/${file}"
    DEPENDS "${python_folder}/${file}" VERBATIM)
  list(APPEND python_copies "${TYNDALL_PYTHON_PACKAGES}/${file}")
  install(FILES "${python_folder}/${file}" DESTINATION "${python_destination}/tyndall" COMPONENT "python")
endforeach ()
add_custom_target(TyndallPythonPackage ALL DEPENDS ${python_copies})
