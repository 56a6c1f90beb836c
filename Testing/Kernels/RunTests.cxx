#include <gtest/gtest.h>

/// As GoogleTest's own, but that 125 tells ctest of tests that were all skipped.
int main(int count, char** arguments)
{
  testing::InitGoogleTest(&count, arguments);
  const int failed = RUN_ALL_TESTS();
  const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
  return failed == 0 && tests.skipped_test_count() > 0 && tests.successful_test_count() == 0 ? 125 : failed;
}
