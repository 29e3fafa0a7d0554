// SPDX-License-Identifier: MIT
#include "relume/basis/sh.h"

#include "relume/core/check.h"

namespace relume::basis {

void shValues(Direction d, std::span<float> values) {
  RELUME_CHECK_LE(values.size(), kShMost);
  const float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  const std::size_t bands = bandOf(values.size() - 1) + 1;
  RELUME_CHECK_EQ(values.size(), bands * bands);
  values[0] = 0.28209479177387814f;
  if (bands == 1) return;
  values[1] = 0.4886025119029199f * y, values[2] = 0.4886025119029199f * z,
  values[3] = 0.4886025119029199f * x;
  if (bands == 2) return;
  values[4] = 1.0925484305920792f * x * y, values[5] = 1.0925484305920792f * y * z;
  values[6] = 0.31539156525252005f * (3 * zz - 1), values[7] = 1.0925484305920792f * x * z;
  values[8] = 0.5462742152960396f * (xx - yy);
  if (bands == 3) return;
  values[9] = 0.5900435899266435f * y * (3 * xx - yy), values[10] = 2.890611442640554f * x * y * z;
  values[11] = 0.4570457994644658f * y * (5 * zz - 1), values[12] = 0.3731763325901154f * z * (5 * zz - 3);
  values[13] = 0.4570457994644658f * x * (5 * zz - 1), values[14] = 1.445305721320277f * z * (xx - yy);
  values[15] = 0.5900435899266435f * x * (xx - 3 * yy);
  if (bands == 4) return;
  values[16] = 2.5033429417967046f * x * y * (xx - yy);
  values[17] = 1.7701307697799304f * y * z * (3 * xx - yy);
  values[18] = 0.9461746957575601f * x * y * (7 * zz - 1);
  values[19] = 0.6690465435572892f * y * z * (7 * zz - 3);
  values[20] = 0.10578554691520431f * (35 * zz * zz - 30 * zz + 3);
  values[21] = 0.6690465435572892f * x * z * (7 * zz - 3);
  values[22] = 0.47308734787878004f * (xx - yy) * (7 * zz - 1);
  values[23] = 1.7701307697799304f * x * z * (xx - 3 * yy);
  values[24] = 0.6258357354491761f * (xx * xx - 6 * xx * yy + yy * yy);
}

Irradiance shIrradiance(std::span<const float> radiance, Normal n) {
  std::array<float, kShMost> y;
  const std::size_t functions = radiance.size() / 3;
  shValues(n, std::span(y).first(functions));
  Vec3 e(0.0f);
  for (std::size_t i = 0; i < functions; ++i)
    e += kCosineFactor[bandOf(i)] * y[i] * Vec3(radiance[3 * i], radiance[3 * i + 1], radiance[3 * i + 2]);
  return Irradiance(e);
}

}  // namespace relume::basis
