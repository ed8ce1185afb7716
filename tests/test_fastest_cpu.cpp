#include "lab/methods/FastestCpu.hpp"

#include <gtest/gtest.h>

using namespace lab;

TEST(FastestCpuTest, IsOneThatThisProcessorHasAndChangesNothing) {
  const lanes::Cpu before = lanes::cpu;
  lanes::cpu = lanes::Cpu::plain;
  EXPECT_LE(fastest_cpu(), lanes::best_cpu());
  EXPECT_EQ(lanes::cpu, lanes::Cpu::plain);
  lanes::cpu = before;
}
