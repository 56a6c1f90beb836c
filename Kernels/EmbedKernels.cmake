# Puts OpenCL sources into a library, so that nothing is read from disk at run time.
#
#   tyndall_embed_kernels(<target> [<file.cl> ...])
#
# Folder/Deposit.cl becomes the constant tyndall::kernel_source::Deposit, a std::string_view that ends in a zero byte,
# declared in a generated header that is named after the target: TyndallKernels has "TyndallKernelSources.h". Editing a
# .cl file rebuilds just its constant.
#
# The same file run as a script (cmake -D INPUT= -D OUTPUT= -D NAME= -D HEADER= -P) writes the constant of one .cl file.

if (CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  file(READ "${INPUT}" rest)
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
      COMMAND "${CMAKE_COMMAND}" "-DINPUT=${input}" "-DOUTPUT=${output}" "-DNAME=${name}"
              "-DHEADER=${header}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
      DEPENDS "${input}" "${CMAKE_CURRENT_FUNCTION_LIST_FILE}"
      COMMENT "Embedding ${file}"
      VERBATIM)
    target_sources("${target}" PRIVATE "${output}")
  endforeach ()

  file(CONFIGURE OUTPUT "${folder}/${header}" @ONLY CONTENT "// Made by EmbedKernels.cmake.
#pragma once

#include <string_view>

/// The OpenCL sources in this library, each named after its file.
namespace tyndall::kernel_source
{
@declarations@}
")
  # Visible to the library and its tests, which build kernels from the same sources.
  target_include_directories("${target}" PUBLIC "$<BUILD_INTERFACE:${folder}>")
endfunction ()
