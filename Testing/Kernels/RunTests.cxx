#include <cstdlib>
#include <gtest/gtest.h>

/// As GoogleTest's own, but that 125 tells ctest of tests that were all skipped, and that a division by zero ends it:
/// PoCL 3 goes on after those of the host, too.
int main(int count, char** arguments)
{
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  testing::InitGoogleTest(&count, arguments);
  const int failed = RUN_ALL_TESTS();
  const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
  return failed == 0 && tests.skipped_test_count() > 0 && tests.successful_test_count() == 0 ? 125 : failed;
}
