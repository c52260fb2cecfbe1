#pragma once

/// What the module is made of, each part in a unit of its own.

#include <pybind11/pybind11.h>

namespace epafi::python {

void defineScenes(pybind11::module_& module);   ///< Run and solve_scene
void definePrograms(pybind11::module_& module); ///< solve_program
void defineMatrices(pybind11::module_& module); ///< Problem
void defineSurfaces(pybind11::module_& module); ///< joint_of
void defineSystems(pybind11::module_& module);  ///< system_of

} // namespace epafi::python
