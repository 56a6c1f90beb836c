# CPack runs this before it closes the packages: what Debian wants in other places than `cmake --install` puts it.
file(GLOB packages LIST_DIRECTORIES true "${CPACK_TEMPORARY_DIRECTORY}/*/usr")
foreach (root IN LISTS packages)
  # Python modules of packages. As deep as before, so the way from there to the library ($ORIGIN) stays right.
  file(GLOB modules LIST_DIRECTORIES true "${root}/lib/python3.*/site-packages/tyndall")
  if (modules)
    file(MAKE_DIRECTORY "${root}/lib/python3/dist-packages")
    file(RENAME "${modules}" "${root}/lib/python3/dist-packages/tyndall")
    cmake_path(GET modules PARENT_PATH emptied)
    cmake_path(GET emptied PARENT_PATH emptied)
    file(REMOVE_RECURSE "${emptied}")
  endif ()
  # The licence, under the package's own name: several packages cannot hold one file.
  cmake_path(GET root PARENT_PATH group)
  cmake_path(GET group FILENAME group)
  string(TOUPPER "${group}" group)
  file(REMOVE_RECURSE "${root}/share/licenses")
  file(MAKE_DIRECTORY "${root}/share/doc/${CPACK_DEBIAN_${group}_PACKAGE_NAME}")
  configure_file("${CPACK_RESOURCE_FILE_LICENSE}"
    "${root}/share/doc/${CPACK_DEBIAN_${group}_PACKAGE_NAME}/copyright" COPYONLY)
endforeach ()
