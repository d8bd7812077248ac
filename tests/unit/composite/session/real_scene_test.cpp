// When the fused model is extracted anew.
#include "composite/session/real_scene.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

TEST(ModelDue, AYoungModelIsRenewedAtPowersOfTwo) {
    const int due[] = {0, 1, 2, 2, 4, 4, 4, 4, 8, 8, 10, 10};
    for (int seen = 0; seen < 12; ++seen)
        EXPECT_EQ(model_due(seen, 10), due[seen]) << seen;
}

TEST(ModelDue, AfterThatAtMultiplesOfTheInterval) {
    EXPECT_EQ(model_due(19, 10), 10);
    EXPECT_EQ(model_due(20, 10), 20);
    for (int seen = 0; seen < 5; ++seen)
        EXPECT_EQ(model_due(seen, 1), seen);
}

}  // namespace
}  // namespace inlay
