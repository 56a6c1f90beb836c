#pragma once

#include "OneCore.h"

#include "Device/Buffer.h"
#include "Device/Device.h"
#include "Device/Errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

/// A test that needs an OpenCL device: skipped where there is none, failed there if TYNDALL_REQUIRE_DEVICE is set.
class DeviceTest : public testing::Test
{
protected:
  void SetUp() override
  {
    try
    {
      this->TheDevice = tyndall::Device::Find();
      if (!ThreadsMeet())
      {
        KeepToOneCore();
      }
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

  /// Whether threads of the device write to the same places, or wait for each other within a kernel: on two cores they
  /// do so at the same time.
  static bool ThreadsMeet()
  {
    const std::string suite = testing::UnitTest::GetInstance()->current_test_info()->test_suite_name();
    const std::vector<std::string> suites = { "ChainedPlanes", "Photon", "Streaming" };
    return std::any_of(
      suites.begin(), suites.end(), [&](const std::string& name) { return suite.find(name) != std::string::npos; });
  }

  tyndall::Device& GetDevice() { return *this->TheDevice; }

  std::shared_ptr<tyndall::Device> TheDevice;
};

/// Takes a device's memory but for at most `rest` bytes, until it goes. Never touched: takes no real memory.
inline std::vector<tyndall::Buffer<char>> AllMemoryBut(tyndall::Device& device, std::size_t rest)
{
  std::vector<tyndall::Buffer<char>> hoard;
  const auto left = [&] { return device.MemoryLimit() - device.BytesInUse(); };
  while (left() > rest)
  {
    hoard.emplace_back(device, std::min(device.AllocationLimit(), left() - rest), "nothing");
  }
  return hoard;
}
