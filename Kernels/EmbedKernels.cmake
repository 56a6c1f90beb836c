# Puts OpenCL sources into a library, so that nothing is read from disk at run time.
#
#   tyndall_embed_kernels(<target> [<file.cl> ...])
#
# Folder/Deposit.cl becomes the constant tyndall::kernel_source::Deposit, a std::string_view that ends in a zero byte,
# declared in a generated header that is named after the target: TyndallKernels has "TyndallKernelSources.h". Editing a
# .cl file rebuilds just the constants that hold it.
#
# A source says itself what it needs: a line #include "Folder/Other.cl" (or a .h that C++ and OpenCL share), with the
# path from the current source folder on, is replaced by that file. One with a line #pragma once is taken once.
#
# The same file run as a script (cmake -D INPUT= -D ROOT= -D OUTPUT= -D DEPFILE= -D NAME= -D HEADER= -P) writes the
# constant of one .cl file.

cmake_policy(SET CMP0057 NEW) # IN_LIST, also as a script

# The text of a file with what it includes, in `text`; adds the files that were read to the global property EMBEDDED.
function (tyndall_expand file root text)
  get_property(read GLOBAL PROPERTY EMBEDDED)
  file(READ "${file}" rest)
  string(FIND "\n${rest}" "\n#pragma once\n" once)
  if (NOT once EQUAL -1)
    if ("${file}" IN_LIST read)
      set(${text} "" PARENT_SCOPE)
      return ()
    endif ()
    string(REPLACE "#pragma once\n" "" rest "${rest}")
  endif ()
  set_property(GLOBAL APPEND PROPERTY EMBEDDED "${file}")
  set(all "")
  string(REGEX MATCH "(^|\n)#include \"([^\"\n]+)\"[^\n]*" line "${rest}")
  while (line)
    set(other "${root}/${CMAKE_MATCH_2}")
    if (NOT EXISTS "${other}")
      message(FATAL_ERROR "${file} includes \"${CMAKE_MATCH_2}\", which is not in ${root}.")
    endif ()
    string(FIND "${rest}" "${line}" place)
    string(SUBSTRING "${rest}" 0 ${place} before)
    string(LENGTH "${line}" length)
    math(EXPR place "${place} + ${length}")
    string(SUBSTRING "${rest}" ${place} -1 rest)
    tyndall_expand("${other}" "${root}" inner)
    string(APPEND all "${before}\n${inner}")
    string(REGEX MATCH "(^|\n)#include \"([^\"\n]+)\"[^\n]*" line "${rest}")
  endwhile ()
  set(${text} "${all}${rest}" PARENT_SCOPE)
endfunction ()

if (CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  tyndall_expand("${INPUT}" "${ROOT}" rest)
  get_property(read GLOBAL PROPERTY EMBEDDED)
  list(REMOVE_DUPLICATES read)
  string(REPLACE " " "\\ " read "${read}")
  string(REPLACE ";" " " read "${read}")
  file(WRITE "${DEPFILE}" "${OUTPUT}: ${read}\n")
  set(literals "")
  # Some compilers refuse a string literal of 64 kB, so that a long file becomes several, cut at line ends.
  set(longest 60000)
  string(LENGTH "${rest}" length)
  while (length GREATER longest)
    string(SUBSTRING "${rest}" 0 ${longest} piece)
    string(FIND "${piece}" "\n" cut REVERSE)
    math(EXPR cut "${cut} + 1")
    if (cut EQUAL 0)
      set(cut ${longest})
    endif ()
    string(SUBSTRING "${rest}" 0 ${cut} piece)
    string(SUBSTRING "${rest}" ${cut} -1 rest)
    string(APPEND literals "R\"cl_source(${piece})cl_source\"\n")
    string(LENGTH "${rest}" length)
  endwhile ()
  string(APPEND literals "R\"cl_source(${rest})cl_source\"")
  file(WRITE "${OUTPUT}" "// Made from ${INPUT} by EmbedKernels.cmake.
#include \"${HEADER}\"

namespace tyndall::kernel_source
{
const std::string_view ${NAME} = ${literals};
}
")
  return ()
endif ()

function (tyndall_embed_kernels target)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${target}Embedded")
  string(REGEX REPLACE "s$" "" header "${target}")
  string(APPEND header "Sources.h")
  set(names "")
  set(declarations "")
  foreach (file IN LISTS ARGN)
    get_filename_component(name "${file}" NAME_WE)
    if (name IN_LIST names)
      message(FATAL_ERROR "tyndall_embed_kernels: two files are called ${name}.cl; their constants would be one.")
    endif ()
    list(APPEND names "${name}")
    string(APPEND declarations "extern const std::string_view ${name}; ///< ${file}\n")

    get_filename_component(input "${file}" ABSOLUTE)
    set(output "${folder}/${name}.cxx")
    add_custom_command(
      OUTPUT "${output}"
      COMMAND "${CMAKE_COMMAND}" "-DINPUT=${input}" "-DROOT=${CMAKE_CURRENT_SOURCE_DIR}" "-DOUTPUT=${output}"
              "-DDEPFILE=${output}.d" "-DNAME=${name}" "-DHEADER=${header}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
      DEPENDS "${input}" "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
      DEPFILE "${output}.d"
      COMMENT "Embedding ${file}"
      VERBATIM)
    target_sources("${target}" PRIVATE "${output}")
  endforeach ()

  file(CONFIGURE OUTPUT "${folder}/${header}" @ONLY CONTENT "// Made by EmbedKernels.cmake.
#pragma once

#include <string_view>

/// The OpenCL sources in this library, each named after its file, with what it includes.
namespace tyndall::kernel_source
{
@declarations@}
")
  # Visible to the library and its tests, which build kernels from the same sources.
  target_include_directories("${target}" PUBLIC "$<BUILD_INTERFACE:${folder}>")
endfunction ()
