// A build without Boost.Beast.
#include <gtest/gtest.h>

#include <algorithm>

#include "crumble/device/open.hpp"
#include "device/samples.hpp"

namespace crumble {
namespace {

TEST(Inverse3, IsRefusedInWordsWithoutBoost) {
  const auto kinds = available_devices();
  EXPECT_EQ(std::find(kinds.begin(), kinds.end(), DeviceKind::inverse3), kinds.end());
  const Error error = error_of([] { open_device({.kind = DeviceKind::inverse3}); });
  EXPECT_EQ(error.code(), Code::unsupported);
  EXPECT_TRUE(mentions(error, "this build was made without Boost.Beast")) << error.what();
}

TEST(Inverse3, AgainstItsService) {
  GTEST_SKIP() << "this build was made without Boost.Beast";
}

}  // namespace
}  // namespace crumble
