#pragma once

#include "Device/Errors.h"

#include <string>

/// What the error says that a call throws; empty if it throws none.
template <class Error = tyndall::InvalidInput, class Call>
std::string ErrorWords(const Call& call)
{
  try
  {
    call();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}
