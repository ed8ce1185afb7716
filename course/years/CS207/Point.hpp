#pragma once
/** @file Point.hpp
 * CME212/Point.hpp by its name in years whose folder is CS207. */
#include "CME212/Point.hpp"
