#pragma once

/// The only header that includes OpenVDB. OpenVDB's templates keep default visibility, although the module hides its
/// other symbols. Otherwise std::call_once, which OpenVDB instantiates and which is always visible, would run the
/// module's copy of a function with the library's copy of the variable that it sets, and openvdb::initialize would read
/// a null pointer.
#pragma GCC visibility push(default)
#include <openvdb/io/Compression.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#pragma GCC visibility pop
