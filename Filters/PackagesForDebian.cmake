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
  # Licence and changes, under the package's own name: several packages cannot hold one file.
  cmake_path(GET root PARENT_PATH group)
  cmake_path(GET group FILENAME group)
  string(TOUPPER "${group}" group)
  file(REMOVE_RECURSE "${root}/share/licenses")
  set(package "${CPACK_DEBIAN_${group}_PACKAGE_NAME}")
  set(documents "${root}/share/doc/${package}")
  file(MAKE_DIRECTORY "${documents}")
  file(READ "${CPACK_RESOURCE_FILE_LICENSE}" licence)
  string(REGEX REPLACE "^[^\n]*\n\n[^\n]*\n" "" licence "${licence}") # its name and the owners
  string(STRIP "${licence}" licence)
  string(REPLACE "\n\n" "\n.\n" licence "${licence}")
  string(REPLACE "\n" "\n " licence "${licence}")
  file(WRITE "${documents}/copyright"
    "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: Tyndall\n\n"
    "Files: *\nCopyright: the Tyndall authors\nLicense: BSD-3-Clause\n ${licence}\n")
  configure_file("${CPACK_TYNDALL_CHANGES}" "${documents}/CHANGELOG.md" COPYONLY)
  string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC) # that of SOURCE_DATE_EPOCH, where it is set
  file(STRINGS "/etc/os-release" release REGEX "^VERSION_CODENAME=")
  string(REPLACE "VERSION_CODENAME=" "" release "${release}")
  file(WRITE "${documents}/changelog"
    "tyndall (${CPACK_PACKAGE_VERSION}) ${release}; urgency=medium\n\n"
    "  * Made by CPack. What changed in Tyndall is in CHANGELOG.md.gz.\n\n"
    " -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")
  execute_process(COMMAND gzip -9n "${documents}/changelog" "${documents}/CHANGELOG.md" COMMAND_ERROR_IS_FATAL ANY)
endforeach ()
