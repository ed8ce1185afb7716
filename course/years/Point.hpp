#pragma once
/** @file Point.hpp
 * CME212/Point.hpp by its name in years that have it in the root. */
#include "CME212/Point.hpp"
