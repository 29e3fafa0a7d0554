// SPDX-License-Identifier: MIT
// The end of export: accessors and buffer views that nothing refers to are dropped and the rest is numbered
// anew; of views that accessors use in part, the unused bytes are cut out; all bytes are joined into one
// binary.
//
// An extension that is not known here may refer to accessors and views in ways that cannot be followed. Then
// those of the document keep their numbers, and only what export itself appended (asset.extras.relume says
// from where on) is renumbered.
#include <algorithm>
#include <set>

#include "export.h"
#include "extensions.h"
#include "glb.h"

namespace relume::scene::gltf {

using Json = nlohmann::json;

namespace {

template <class Visit>
void visitField(Json* object, const char* key, Visit visit) {
  if (Json* field = object ? fieldOf(*object, key) : nullptr; field && field->is_number()) visit(*field);
}

template <class Visit>
void visitElements(Json* array, Visit visit) {
  if (array && array->is_structured())
    for (Json& element : *array) visit(element);
}

/// Calls visit with every number that names an accessor.
template <class Visit>
void visitAccessorReferences(Json& doc, Visit visit) {
  const auto visitAll = [&](Json* attributes) {
    visitElements(attributes, [&](Json& reference) {
      if (reference.is_number()) visit(reference);
    });
  };
  visitPrimitives(doc, [&](Json& primitive, std::uint32_t, std::uint32_t) {
    visitAll(fieldOf(primitive, "attributes"));
    visitField(&primitive, "indices", visit);
    visitElements(fieldOf(primitive, "targets"), [&](Json& target) { visitAll(&target); });
  });
  visitElements(fieldOf(doc, "animations"), [&](Json& animation) {
    visitElements(fieldOf(animation, "samplers"), [&](Json& sampler) {
      visitField(&sampler, "input", visit);
      visitField(&sampler, "output", visit);
    });
  });
  visitElements(fieldOf(doc, "skins"), [&](Json& skin) { visitField(&skin, "inverseBindMatrices", visit); });
  visitElements(fieldOf(doc, "nodes"), [&](Json& node) {
    Json* extensions = fieldOf(node, "extensions");
    Json* instancing = extensions ? fieldOf(*extensions, kInstancingExtension) : nullptr;
    if (instancing) visitAll(fieldOf(*instancing, "attributes"));
  });
}

template <class Visit>
void visitNestedViews(Json& value, Visit visit) {
  if (value.is_structured())
    for (auto& [key, child] : value.items()) {
      if (key == "bufferView" && child.is_number())
        visit(child);
      else
        visitNestedViews(child, visit);
    }
}

/// Calls visit with every number that names a buffer view, but for accessors[].bufferView.
template <class Visit>
void visitWholeViewReferences(Json& doc, Visit visit) {
  visitElements(fieldOf(doc, "accessors"), [&](Json& accessor) {
    if (Json* sparse = fieldOf(accessor, "sparse")) {
      visitField(fieldOf(*sparse, "indices"), "bufferView", visit);
      visitField(fieldOf(*sparse, "values"), "bufferView", visit);
    }
  });
  visitElements(fieldOf(doc, "images"), [&](Json& image) { visitField(&image, "bufferView", visit); });
  visitPrimitives(doc, [&](Json& primitive, std::uint32_t, std::uint32_t) {
    Json* extensions = fieldOf(primitive, "extensions");
    visitField(extensions ? fieldOf(*extensions, kDracoExtension) : nullptr, "bufferView", visit);
  });
  Json* extensions = fieldOf(doc, "extensions");
  if (Json* transfer = extensions ? fieldOf(*extensions, kTransferExtension) : nullptr)
    visitNestedViews(*transfer, visit);
}

bool knowsAllExtensions(Json& value) {
  if (!value.is_structured()) return true;
  for (auto& [key, child] : value.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && child.is_object())
      for (const auto& [name, unused] : child.items())
        if (!isRenumberable(name)) return false;
    if (!knowsAllExtensions(child)) return false;
  }
  return true;
}

/// Drops the unused elements of doc[list] from `first` on. Returns the old number of each one that is left.
template <class VisitReferences>
std::vector<std::uint32_t> compact(Json& doc, const char* list, std::size_t first,
                                   VisitReferences visit_references) {
  Json* found = fieldOf(doc, list);
  if (!found || !found->is_array()) return {};
  const std::size_t count = found->size();
  std::vector<bool> used(count);
  std::fill_n(used.begin(), std::min(first, count), true);
  visit_references([&](Json& reference) {
    if (const auto i = asIndex(reference, count)) used[*i] = true;
  });
  std::vector<std::uint32_t> renumbered(count, kNone), left;
  Json kept = Json::array();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!used[i]) continue;
    renumbered[i] = static_cast<std::uint32_t>(left.size());
    left.push_back(i);
    kept.push_back(std::move((*found)[i]));
  }
  *found = std::move(kept);
  visit_references([&](Json& reference) {
    if (const auto i = asIndex(reference, count)) reference = renumbered[*i];
  });
  if (found->empty()) doc.erase(list);
  return left;
}

/// What an accessor covers of its view, in bytes.
struct Range {
  std::size_t begin, end;
};

/// Cuts what no accessor covers out of the views that accessors alone refer to.
void trimViews(Output& out) {
  Json* views = fieldOf(out.doc, "bufferViews");
  Json* accessors = fieldOf(out.doc, "accessors");
  if (!views || !accessors) return;
  std::vector<std::vector<Range>> covered(out.pieces.size());
  std::vector<bool> whole(out.pieces.size());
  const auto mark = [&](const Json& reference) {
    if (const auto v = asIndex(reference, whole.size())) whole[*v] = true;
  };
  visitWholeViewReferences(out.doc, mark);
  const auto viewOf = [&](Json& accessor) {
    Json* reference = fieldOf(accessor, "bufferView");
    return reference ? asIndex(*reference, whole.size()) : std::nullopt;
  };
  const std::string nowhere;
  for (Json& json : *accessors) {
    const auto v = viewOf(json);
    if (!v || whole[*v]) continue;
    try {
      const ElementLayout layout = layoutOf(Value(nowhere, json), Value(nowhere, (*views)[*v]));
      const std::size_t begin = Value(nowhere, json)["byteOffset"].integer(0);
      const std::size_t end =
          begin + (layout.count == 0 ? 0 : layout.stride * (layout.count - 1) + layout.element_size);
      covered[*v].push_back({begin / 4 * 4, alignedSize(end)});
    } catch (const Error&) {
      whole[*v] = true;  // import had no use for this accessor, so did not refuse it
    }
  }
  for (std::uint32_t v = 0; v < out.pieces.size(); ++v) {
    Output::Piece& piece = out.pieces[v];
    if (whole[v] || covered[v].empty() || piece.input_view == kNone) continue;
    std::ranges::sort(covered[v], {}, &Range::begin);
    std::vector<Range> merged;
    for (const Range& r : covered[v])
      if (!merged.empty() && r.begin <= merged.back().end)
        merged.back().end = std::max(merged.back().end, r.end);
      else
        merged.push_back(r);
    const auto bytes = out.in.viewBytes(piece.input_view);
    if (alignedSize(bytes.size()) < merged.back().end) continue;
    merged.back().end = std::min(merged.back().end, bytes.size());
    std::size_t kept = 0;
    for (const Range& r : merged) kept += r.end - r.begin;
    if (kept == bytes.size()) continue;

    for (Json& json : *accessors) {
      if (viewOf(json) != v) continue;
      const std::size_t offset = Value(nowhere, json)["byteOffset"].integer(0);
      std::size_t before = 0;
      for (const Range& r : merged) {
        if (offset < r.end || &r == &merged.back()) {
          json["byteOffset"] = before + (offset - r.begin);
          break;
        }
        before += r.end - r.begin;
      }
    }
    for (const Range& r : merged)
      piece.bytes.insert(piece.bytes.end(), bytes.begin() + static_cast<std::ptrdiff_t>(r.begin),
                         bytes.begin() + static_cast<std::ptrdiff_t>(r.end));
    piece.input_view = kNone;
    (*views)[v]["byteLength"] = piece.bytes.size();
  }
}

/// How many accessors and views the document had before it was first baked, in case they keep their numbers.
std::size_t keptCount(Json& doc, const char* list, bool renumber_all, std::size_t input_count) {
  Json& asset = doc["asset"];
  if (renumber_all) {
    eraseNote(asset, list);
    return 0;
  }
  if (Json* noted = findNote(asset, list))
    if (const auto count = asIndex(*noted, input_count + 1)) return *count;
  notesOf(asset)[list] = input_count;
  return input_count;
}

}  // namespace

std::vector<std::byte> assemble(Output& out) {
  Json& doc = out.doc;
  const bool renumber_all = knowsAllExtensions(doc);
  const Value input = out.in.root();
  const std::size_t kept_accessors = keptCount(doc, "accessors", renumber_all, input["accessors"].size());
  const std::size_t kept_views = keptCount(doc, "bufferViews", renumber_all, input["bufferViews"].size());
  compact(doc, "accessors", kept_accessors, [&](auto visit) { visitAccessorReferences(doc, visit); });
  const std::vector<std::uint32_t> left = compact(doc, "bufferViews", kept_views, [&](auto visit) {
    visitElements(fieldOf(doc, "accessors"),
                  [&](Json& accessor) { visitField(&accessor, "bufferView", visit); });
    visitWholeViewReferences(doc, visit);
  });
  std::vector<Output::Piece> pieces;
  for (const std::uint32_t v : left) pieces.push_back(std::move(out.pieces[v]));
  out.pieces = std::move(pieces);
  if (renumber_all) trimViews(out);

  std::vector<std::span<const std::byte>> binary;
  std::size_t offset = 0;
  for (std::uint32_t v = 0; v < out.pieces.size(); ++v) {
    const Output::Piece& piece = out.pieces[v];
    binary.push_back(piece.input_view == kNone ? std::span<const std::byte>(piece.bytes)
                                               : out.in.viewBytes(piece.input_view));
    Json& view = doc["bufferViews"][v];
    view["buffer"] = 0;
    view["byteOffset"] = offset;
    view["byteLength"] = binary.back().size();
    offset += alignedSize(binary.back().size());
  }
  Json buffer = Json::object();
  if (Json* buffers = fieldOf(doc, "buffers"); buffers && buffers->is_array() && !buffers->empty())
    buffer = (*buffers)[0];
  for (const char* name : kMeshoptExtensions) eraseExtension(buffer, name);
  buffer.erase("uri");
  buffer["byteLength"] = offset;
  if (binary.empty())
    doc.erase("buffers");
  else
    doc["buffers"] = Json::array({std::move(buffer)});
  return joinGlb(doc.dump(), binary);
}

}  // namespace relume::scene::gltf
