#pragma once

#include "Device/Device.h"
#include "Device/Errors.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

/// A test that needs an OpenCL device: skipped where there is none, failed there if TYNDALL_REQUIRE_DEVICE is set.
class DeviceTest : public testing::Test
{
protected:
  void SetUp() override
  {
    try
    {
      this->TheDevice = tyndall::Device::Find();
    }
    catch (const tyndall::DeviceError& error)
    {
      if (std::getenv("TYNDALL_REQUIRE_DEVICE"))
      {
        FAIL() << error.what();
      }
      GTEST_SKIP() << error.what();
    }
  }

  tyndall::Device& GetDevice() { return *this->TheDevice; }

  std::shared_ptr<tyndall::Device> TheDevice;
};
