// SPDX-License-Identifier: MIT
// Any bytes as a glTF file: they are refused with an Error, or imported, baked (without light) and exported,
// and what was exported is imported again. The mutator keeps the lengths in a .glb right, or nearly every
// change would end at the header.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "fake_bake.h"
#include "glb.h"
#include "relume/scene/gltf.h"

namespace gltf = relume::scene::gltf;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> baked;
  try {
    const auto document = gltf::Document::parse({reinterpret_cast<const std::byte*>(data), size}, "fuzz", {});
    relume::Warnings warnings;
    const auto scene = gltf::import(document, warnings);
    baked = gltf::exportGlb(document, scene, gltf::fakeBake(scene, {.split = size % 2 == 0, .pages = 2}));
  } catch (const relume::Error&) {
    return 0;
  }
  relume::Warnings warnings;
  try {
    gltf::import(gltf::Document::parse(baked, "fuzz", {}), warnings);
  } catch (const relume::Error& error) {
    // Export writes what import reads.
    std::fprintf(stderr, "%s\n", error.what());
    std::abort();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  const std::span<const std::byte> file(reinterpret_cast<const std::byte*>(data), size);
  if (!gltf::isGlb(file) || seed % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  try {
    const gltf::GlbChunks chunks = gltf::splitGlb(file, "fuzz");
    std::string json(chunks.json);
    std::vector<std::byte> binary;
    if (chunks.binary) binary.assign(chunks.binary->begin(), chunks.binary->end());
    const auto mutate = [&](auto& bytes) {
      const std::size_t before = bytes.size(), room = before + 64;
      bytes.resize(room);
      bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), before, room));
    };
    if (seed % 4 == 1 && !binary.empty())
      mutate(binary);
    else
      mutate(json);
    std::vector<std::span<const std::byte>> pieces;
    if (!binary.empty()) pieces.emplace_back(binary);
    const std::vector<std::byte> out = gltf::joinGlb(json, pieces);
    if (out.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, out.data(), out.size());
    return out.size();
  } catch (const relume::Error&) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
}
