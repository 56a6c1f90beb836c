# Finds the host, builds the module Tyndall::LightTransport for it, and ParaView's plugin where the host is ParaView.
# Sets TYNDALL_HOST ("ParaView 5.11.0", "VTK 9.1.0").

include(Filters/MendedParaView.cmake)
if (TYNDALL_WITH_PARAVIEW)
  tyndall_mend_paraview()
  # Without components ParaView wants every Qt development file there is.
  find_package(ParaView 5.11 QUIET COMPONENTS RemotingServerManager RemotingApplication)
endif ()
set(wrapping OFF)
set(library_destination "${CMAKE_INSTALL_LIBDIR}")
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
    include(Filters/TypesOfVTK.cmake)
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
  VERSION "${PROJECT_VERSION}"
  SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/Tyndall"
  LIBRARY_DESTINATION "${library_destination}"
  HIERARCHY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/vtk/hierarchy/Tyndall"
  CMAKE_DESTINATION "${TYNDALL_CMAKE_DESTINATION}"
  TEST_DIRECTORY_NAME NONE)

if (wrapping)
  include(Filters/Python.cmake)
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
