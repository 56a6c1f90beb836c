# Debian packages by CPack (./run package), of this build tree as it is: for ParaView tyndall-paraview, for plain VTK
# libtyndall0.2, libtyndall-dev and python3-tyndall. They are packed for /usr, where Debian's programs look.
set(library_package "libtyndall${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
set(opencl "pocl-opencl-icd | opencl-icd")
if (Python3_VERSION_MINOR) # compiled for one Python
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(python "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
endif ()

# Who answers for a package is who makes it; the project itself has no address.
set(TYNDALL_PACKAGE_MAINTAINER "The Tyndall authors <noreply@tyndall.invalid>" CACHE STRING
  "Name and address in the Debian packages: of who makes them")
set(debian_made "${CMAKE_BINARY_DIR}/Debian")
set(postinst [=[
#!/bin/sh
# Python's modules are compiled when they are installed, as those of Debian's own packages are.
set -e
if [ "$1" = "configure" ] && command -v py3compile >/dev/null; then
  py3compile -p @package@
fi
]=])
set(prerm [=[
#!/bin/sh
# What was compiled goes first, so that the folder is empty when the package goes.
set -e
if command -v py3clean >/dev/null; then
  py3clean -p @package@
fi
]=])

# tyndall_package(<group> <package> SUMMARY <text> [DEPENDS <list>] [CONFLICTS <list>] [CONTROL <file>...]
# COMPONENTS <component>...): a package of what is installed as these components, with these files of control. The
# libraries that it depends on are found by dpkg-shlibdeps. Python's modules in it are compiled where it is installed.
set(CPACK_COMPONENTS_ALL "")
function (tyndall_package group package)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "SUMMARY;DEPENDS;CONFLICTS" "COMPONENTS;CONTROL")
  string(TOUPPER "${group}" group_upper)
  set("CPACK_DEBIAN_${group_upper}_PACKAGE_NAME" "${package}" PARENT_SCOPE)
  set("CPACK_DEBIAN_${group_upper}_PACKAGE_DEPENDS" "${arg_DEPENDS}" PARENT_SCOPE)
  set("CPACK_DEBIAN_${group_upper}_PACKAGE_CONFLICTS" "${arg_CONFLICTS}" PARENT_SCOPE)
  set("CPACK_DEBIAN_${group_upper}_DESCRIPTION" "${arg_SUMMARY}" PARENT_SCOPE)
  if ("python" IN_LIST arg_COMPONENTS)
    foreach (script IN ITEMS postinst prerm)
      file(CONFIGURE OUTPUT "${debian_made}/${package}/${script}" CONTENT "${${script}}" @ONLY)
      file(CHMOD "${debian_made}/${package}/${script}" FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
        GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
      list(APPEND arg_CONTROL "${debian_made}/${package}/${script}")
    endforeach ()
  endif ()
  set("CPACK_DEBIAN_${group_upper}_PACKAGE_CONTROL_EXTRA" "${arg_CONTROL}" PARENT_SCOPE)
  foreach (component IN LISTS arg_COMPONENTS)
    string(TOUPPER "${component}" component_upper)
    set("CPACK_COMPONENT_${component_upper}_GROUP" "${group}" PARENT_SCOPE)
  endforeach ()
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${arg_COMPONENTS} PARENT_SCOPE)
endfunction ()

if (TYNDALL_PLUGIN)
  # What Debian's ParaView reads: on Debian 12 paraview.conf beside its executable, a list of plugins a line, seen from
  # there; since Debian 13 the folder share/paraview/plugins, with a folder a plugin.
  if (ParaView_VERSION VERSION_LESS 5.12)
    set(listed "${CMAKE_BINARY_DIR}/paraview.conf")
    set(listed_in "bin")
    file(WRITE "${listed}" "../lib/${TYNDALL_PLUGIN_SUBDIRECTORY}/tyndall.plugins.xml\n")
  else ()
    set(listed "${CMAKE_BINARY_DIR}/share/Tyndall")
    set(listed_in "share/paraview/plugins")
    file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/share")
    file(CREATE_LINK "../../../lib/${TYNDALL_PLUGIN_SUBDIRECTORY}/Tyndall" "${listed}" SYMBOLIC)
  endif ()
  install(FILES "${listed}" DESTINATION "${listed_in}" COMPONENT "paraview_conf" EXCLUDE_FROM_ALL)
  tyndall_package(plugin tyndall-paraview
    SUMMARY "The plugin for ParaView, with scenes to open at once, and the Python package\ntyndall for ParaView's VTK."
    DEPENDS "paraview, python3-paraview, ${python}, ${opencl}"
    CONFLICTS "python3-tyndall" # python3-paraview and python3-vtk9 are in conflict, too
    COMPONENTS runtime paraview_plugins paraview_conf python Unspecified)
else ()
  set(soversion "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
  file(WRITE "${debian_made}/triggers" "activate-noawait ldconfig\n")
  file(WRITE "${debian_made}/shlibs" "libvtkTyndall ${soversion} ${library_package} (= ${PROJECT_VERSION})\n")
  tyndall_package(library ${library_package}
    SUMMARY "The library of VTK filters, for Debian's VTK ${VTK_MAJOR_VERSION}.${VTK_MINOR_VERSION}."
    DEPENDS "${opencl}"
    CONTROL "${debian_made}/shlibs" "${debian_made}/triggers"
    COMPONENTS runtime)
  tyndall_package(headers libtyndall-dev
    SUMMARY "Headers and CMake files of the library of VTK filters."
    DEPENDS "${library_package} (= ${PROJECT_VERSION}), libvtk9-dev"
    COMPONENTS development)
  if (TYNDALL_PYTHON_PACKAGES)
    tyndall_package(modules python3-tyndall
      SUMMARY "The VTK filters for Python and numpy: the package tyndall."
      DEPENDS "${library_package} (= ${PROJECT_VERSION}), python3-vtk9, ${python}"
      CONFLICTS "tyndall-paraview"
      COMPONENTS python)
  endif ()
endif ()

set(CPACK_GENERATOR "DEB")
set(CPACK_PACKAGE_NAME "tyndall")
set(CPACK_PACKAGE_CONTACT "${TYNDALL_PACKAGE_MAINTAINER}")
set(CPACK_TYNDALL_CHANGES "${PROJECT_SOURCE_DIR}/CHANGELOG.md")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION "science")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/PackagesForDebian.cmake")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
