// Runs golden tests; `--update NAME` makes the reference NAME anew instead of testing against it.
#include "tests/support/golden_image.h"

#include <gtest/gtest.h>

#include <cstring>

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    if (argc == 3 && std::strcmp(argv[1], "--update") == 0)
        inlay::test::golden_to_update() = argv[2];
    return RUN_ALL_TESTS();
}
