// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure sst_1994_closure{turbulence::Sst1994::name, "k-omega SST 1994", two_equation_keys(),
                                      SweepsOf<turbulence::Sst1994>::table()};
extern const Closure sst_v_closure{turbulence::SstV::name, "SST 1994, production by vorticity", two_equation_keys(),
                                   SweepsOf<turbulence::SstV>::table()};
extern const Closure sst_vm_closure{turbulence::SstVm::name, "SST 1994, production by vorticity, without 2/3 k",
                                    two_equation_keys(), SweepsOf<turbulence::SstVm>::table()};

}  // namespace spindrift::aero
