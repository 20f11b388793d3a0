// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure sst_closure{turbulence::Sst::name, "k-omega SST 2003", two_equation_keys(),
                                 SweepsOf<turbulence::Sst>::table()};
extern const Closure sst_2003_vm_closure{turbulence::Sst2003Vm::name, "SST 2003, production by vorticity, without 2/3 k",
                                         two_equation_keys(), SweepsOf<turbulence::Sst2003Vm>::table()};

}  // namespace spindrift::aero
