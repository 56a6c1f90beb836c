#pragma once

/// The one place where OpenVDB is included. Its templates keep default visibility although the module hides its
/// symbols:
/// std::call_once, which OpenVDB instantiates, is visible all the same, and would otherwise run the module's copy of a
/// function against the library's copy of the variable that it sets (openvdb::initialize then reads a null pointer).
#pragma GCC visibility push(default)
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#pragma GCC visibility pop
