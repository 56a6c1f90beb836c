# Finds the host, builds the module Tyndall::LightTransport for it, and ParaView's plugin where the host is ParaView.
# Sets TYNDALL_HOST ("ParaView 5.11.0", "VTK 9.1.0").

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

# Debian's VTK 9.1 comes without the lists of its types (hierarchy files) that its wrapping tools read. Makes those that
# are missing of VTK's modules, and of the modules that they depend on, from VTK's headers.
# tyndall_make_types(<module>...)
function (tyndall_make_types)
  get_target_property(tool VTK::WrapHierarchy LOCATION)
  foreach (module IN LISTS ARGN)
    if (NOT TARGET "${module}")
      continue () # only declared: it is in no installed header
    endif ()
    get_target_property(file "${module}" INTERFACE_vtk_module_hierarchy)
    if (NOT file OR EXISTS "${file}")
      continue ()
    endif ()
    get_target_property(depends "${module}" INTERFACE_vtk_module_depends)
    get_target_property(headers "${module}" INTERFACE_vtk_module_headers)
    get_target_property(library "${module}" INTERFACE_vtk_module_library_name)
    tyndall_make_types(${depends})
    set(folder "${CMAKE_BINARY_DIR}/TypesOfVTK")
    set(own "${folder}/${library}-hierarchy.txt")
    set_property(TARGET "${module}" PROPERTY INTERFACE_vtk_module_hierarchy "${own}")
    if (EXISTS "${own}")
      continue ()
    endif ()
    set(of_depends)
    foreach (depend IN LISTS depends)
      get_target_property(types "${depend}" INTERFACE_vtk_module_hierarchy)
      if (types)
        list(APPEND of_depends "${types}")
      endif ()
    endforeach ()
    list(GET headers 0 header)
    get_filename_component(includes "${header}" DIRECTORY)
    set(data)
    foreach (header IN LISTS headers)
      string(APPEND data "${header};${library}\n")
    endforeach ()
    file(WRITE "${folder}/${library}.data" "${data}")
    execute_process(
      COMMAND "${tool}" -I "${includes}" -o "${own}" "${folder}/${library}.data" ${of_depends}
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach ()
endfunction ()

if (TYNDALL_WITH_PARAVIEW)
  tyndall_mend_paraview()
  # Without components ParaView wants every Qt development file there is.
  find_package(ParaView 5.11 QUIET COMPONENTS RemotingServerManager RemotingApplication)
endif ()
set(wrapping OFF)
set(library_destination "${CMAKE_INSTALL_LIBDIR}")
set(library_version VERSION "${PROJECT_VERSION}" SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
if (SKBUILD) # a wheel: holds no symbolic links, and lies beside VTK's libraries
  set(library_destination "tyndall")
  set(library_version)
  list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN/../vtkmodules")
endif ()
if (ParaView_FOUND)
  set(TYNDALL_HOST "ParaView ${ParaView_VERSION}")
  set(wrapping ON) # for the client-server streams of the plugin
  set(TYNDALL_PLUGIN_SUBDIRECTORY "paraview-${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}/plugins")
  # Beside the plugin, as ParaView's own: so the library for plain VTK can be installed in the same prefix.
  set(library_destination "${CMAKE_INSTALL_LIBDIR}/${TYNDALL_PLUGIN_SUBDIRECTORY}/Tyndall")
else ()
  find_package(VTK 9.1 REQUIRED COMPONENTS
    CommonCore CommonDataModel CommonExecutionModel CommonMath FiltersCore IOCore IOImage IOLegacy IOXML ParallelCore
    RenderingCore RenderingVolume TestingCore
    OPTIONAL_COMPONENTS WrappingPythonCore)
  set(TYNDALL_HOST "VTK ${VTK_VERSION}")
  if (VTK_WRAP_PYTHON AND TARGET VTK::WrapPython)
    get_target_property(wrapper VTK::WrapPython LOCATION)
  endif ()
  if (EXISTS "${wrapper}") # Debian has it in a package of its own
    set(wrapping ON)
    tyndall_make_types(${VTK_LIBRARIES})
  endif ()
endif ()

# A vtk.module in the root makes vtk_module_build ask for the binary directory of the whole project. So the module is
# scanned as a folder of the build tree that holds a copy of vtk.module and leads to Filters/CMakeLists.txt.
set(module_folder "${CMAKE_BINARY_DIR}/Module")
configure_file("${PROJECT_SOURCE_DIR}/vtk.module" "${module_folder}/vtk.module" COPYONLY)
file(CONFIGURE OUTPUT "${module_folder}/CMakeLists.txt" @ONLY
  CONTENT "include(\"@PROJECT_SOURCE_DIR@/Filters/CMakeLists.txt\")\n")

# What VTK's rendering is linked with, of which nothing is used here: where its development files are not installed, CMake
# would miss the targets.
foreach (library IN ITEMS GLEW::GLEW X11::X11)
  if (NOT TARGET "${library}")
    add_library("${library}" INTERFACE IMPORTED)
  endif ()
endforeach ()

set(module_files "${module_folder}/vtk.module")
set(requested_modules Tyndall::LightTransport)
if (ParaView_FOUND)
  list(APPEND module_files "${PROJECT_SOURCE_DIR}/Plugin/Representation/vtk.module")
  list(APPEND requested_modules Tyndall::Representation)
endif ()
vtk_module_scan(
  MODULE_FILES ${module_files}
  REQUEST_MODULES ${requested_modules}
  PROVIDES_MODULES module
  HIDE_MODULES_FROM_CACHE ON)

set(TYNDALL_CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Tyndall")
list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN")
vtk_module_build(
  MODULES ${module}
  PACKAGE Tyndall
  INSTALL_EXPORT Tyndall
  INSTALL_HEADERS ON
  ENABLE_WRAPPING ${wrapping}
  ${library_version}
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/Tyndall"
  LIBRARY_DESTINATION "${library_destination}"
  HIERARCHY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/vtk/hierarchy/Tyndall"
  CMAKE_DESTINATION "${TYNDALL_CMAKE_DESTINATION}"
  TEST_DIRECTORY_NAME NONE)

if (wrapping)
  # The classes for Python, and the package around them (Filters/Python/tyndall): for the host's VTK, beside whose Python
  # modules (vtkmodules) it is imported.
  find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
  set(TYNDALL_VTK_ADVICE "Take that folder from PYTHONPATH, or pip's vtk out of the environment, so that Debian's are found.")
  if (SKBUILD) # a wheel, whose root is the prefix
    set(python_destination ".")
    set(TYNDALL_VTK_ADVICE "Install that VTK: python -m pip install vtk==${VTK_VERSION}")
  elseif (CMAKE_INSTALL_PREFIX STREQUAL "/usr")
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

  foreach (file IN ITEMS __init__.py demo.py solving.py)
    configure_file("${CMAKE_CURRENT_LIST_DIR}/Python/tyndall/${file}" "${TYNDALL_PYTHON_PACKAGES}/tyndall/${file}" COPYONLY)
  endforeach ()
  configure_file("${CMAKE_CURRENT_LIST_DIR}/Python/tyndall/host.py.in" "${TYNDALL_PYTHON_PACKAGES}/tyndall/host.py" @ONLY)
  foreach (file IN ITEMS __init__.py demo.py host.py solving.py)
    install(FILES "${TYNDALL_PYTHON_PACKAGES}/tyndall/${file}"
      DESTINATION "${python_destination}/tyndall" COMPONENT "python")
  endforeach ()
  if (SKBUILD) # licences of the libraries that the wheel contains
    foreach (package IN ITEMS libeigen3-dev libglm-dev libopenexr-dev libimath-dev ocl-icd-opencl-dev)
      install(FILES "/usr/share/doc/${package}/copyright"
        DESTINATION "tyndall/licenses" RENAME "${package}.txt" COMPONENT "python")
    endforeach ()
  endif ()
endif ()

if (ParaView_FOUND)
  paraview_plugin_scan(
    PLUGIN_FILES "${PROJECT_SOURCE_DIR}/Plugin/paraview.plugin"
    PROVIDES_PLUGINS plugins
    REQUIRES_MODULES required_modules
    ENABLE_BY_DEFAULT ON
    HIDE_PLUGINS_FROM_CACHE ON)
  paraview_plugin_build(
    PLUGINS ${plugins}
    PLUGINS_FILE_NAME "tyndall.plugins.xml"
    TARGET_COMPONENT "paraview_plugins" # of that file
    LIBRARY_SUBDIRECTORY "${TYNDALL_PLUGIN_SUBDIRECTORY}")
  set(TYNDALL_PLUGIN
    "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/${TYNDALL_PLUGIN_SUBDIRECTORY}/Tyndall/Tyndall${CMAKE_SHARED_MODULE_SUFFIX}")
endif ()

# What find_package(Tyndall) reads.
include(CMakePackageConfigHelpers)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/TyndallConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/${TYNDALL_CMAKE_DESTINATION}/TyndallConfig.cmake"
  INSTALL_DESTINATION "${TYNDALL_CMAKE_DESTINATION}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${TYNDALL_CMAKE_DESTINATION}/TyndallConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(
  FILES "${CMAKE_BINARY_DIR}/${TYNDALL_CMAKE_DESTINATION}/TyndallConfig.cmake"
        "${CMAKE_BINARY_DIR}/${TYNDALL_CMAKE_DESTINATION}/TyndallConfigVersion.cmake"
  DESTINATION "${TYNDALL_CMAKE_DESTINATION}" COMPONENT "development")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/licenses/Tyndall")
