#pragma once
/** @file SDLViewer.hpp
 * CME212/SDLViewer.hpp by its name in years whose folder and namespace are
 * CS207. */
#include "CME212/SDLViewer.hpp"

namespace CME212 {}
namespace CS207 = CME212;
