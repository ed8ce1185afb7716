#include "lab/fast/Lanes.hpp"

#include <gtest/gtest.h>

#include <array>

using namespace lab;

TEST(FastestCpuTest, IsOneThatThisProcessorHasAndChangesNothing) {
  const lanes::Cpu before = lanes::cpu;
  lanes::cpu = lanes::Cpu::plain;
  EXPECT_LE(lanes::fastest_cpu(), lanes::best_cpu());
  EXPECT_EQ(lanes::cpu, lanes::Cpu::plain);
  lanes::cpu = before;
}

TEST(FastestCpuTest, LongerRegistersWinByAClearMarginAlone) {
  const auto choice = [](double plain, double avx2, double avx512) {
    return lanes::clearly_fastest(std::array{plain, avx2, avx512});
  };
  EXPECT_EQ(choice(20, 10, 8), lanes::Cpu::avx512);
  EXPECT_EQ(choice(20, 10, 9.5), lanes::Cpu::avx2);
  EXPECT_EQ(choice(20, 10, 11), lanes::Cpu::avx2);
  EXPECT_EQ(choice(10, 9.5, 8.5), lanes::Cpu::avx512);
  EXPECT_EQ(choice(10, 9.5, 9.5), lanes::Cpu::plain);
  EXPECT_EQ(lanes::clearly_fastest(std::array{10.0}), lanes::Cpu::plain);
}
