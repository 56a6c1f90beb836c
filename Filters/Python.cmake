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
  MODULES Tyndall::LightTransport
  TARGET Tyndall::Python
  PYTHON_PACKAGE "tyndall"
  MODULE_DESTINATION "${python_destination}"
  LIBRARY_DESTINATION "${library_destination}"
  CMAKE_DESTINATION "${TYNDALL_CMAKE_DESTINATION}"
  INSTALL_HEADERS OFF
  COMPONENT "python")

foreach (file IN ITEMS __init__.py solving.py)
  configure_file("${CMAKE_CURRENT_LIST_DIR}/Python/tyndall/${file}" "${TYNDALL_PYTHON_PACKAGES}/tyndall/${file}" COPYONLY)
endforeach ()
configure_file("${CMAKE_CURRENT_LIST_DIR}/Python/tyndall/host.py.in" "${TYNDALL_PYTHON_PACKAGES}/tyndall/host.py" @ONLY)
foreach (file IN ITEMS __init__.py host.py solving.py)
  install(FILES "${TYNDALL_PYTHON_PACKAGES}/tyndall/${file}"
    DESTINATION "${python_destination}/tyndall" COMPONENT "python")
endforeach ()
