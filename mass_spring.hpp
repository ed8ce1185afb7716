#pragma once
/** @file mass_spring.hpp
 * All that a program about mass-spring cloth includes. */
#include "Cloth.hpp"
#include "Constraint.hpp"
#include "Force.hpp"
#include "Integrator.hpp"
