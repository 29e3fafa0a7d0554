// SPDX-License-Identifier: MIT
// What a bake of light paths finds of its own errors, by their causes: so that a user knows which parameter
// would help.
#pragma once
#include <optional>

#include "relume/asset/transfer.h"
#include "relume/transport/light_paths.h"

namespace relume::bake {

/// Under random lamps at least an entry's width from surfaces, at about a thousand exits:
///   entries   irradiance taken at entries against irradiance taken everywhere, by the same rays,
///   transfer  the noise of the rays of exits; of random walks, what they give against gathering.
///   encoding  the product with the stored matrix against the product with the rows it was made from.
/// Nothing where no such lamp finds room. Throws Error kInterrupted.
std::optional<asset::TransferErrors> measureErrors(const transport::LightPaths& paths,
                                                   const transport::LightPathOptions& options,
                                                   const codec::BlockMatrix& matrix, Progress& progress);

}  // namespace relume::bake
