// SPDX-License-Identifier: MIT
// One maker for each family of bases; see makeBasis().
#pragma once
#include "relume/basis/basis.h"

namespace relume::basis {

std::unique_ptr<Basis> makeIrradiance();
std::unique_ptr<Basis> makeSh(std::size_t bands, bool window);
std::unique_ptr<Basis> makeH(std::size_t functions, bool window);
std::unique_ptr<Basis> makeHl2();
std::unique_ptr<Basis> makeCube();
std::unique_ptr<Basis> makeDice();
std::unique_ptr<Basis> makeAhd();
std::unique_ptr<Basis> makeDominant();
std::unique_ptr<Basis> makeFarCry();
std::unique_ptr<Basis> makeGaussians(std::size_t lobes);

}  // namespace relume::basis
