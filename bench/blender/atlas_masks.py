"""Which texels of an atlas can be compared at all: a raster of the charts, 8 x 8 places a texel, that owes nothing to either baker."""
import numpy as np

PLACES = 8  # along the side of a texel
EDGE = 1e-7  # barycentric: places nearer to an edge than this count for one triangle only


def raster(uv, width, height):
    """(triangle [h, w], count [h, w]) at PLACES x PLACES places a texel: one triangle that holds the place, -1 if none, and how many do."""
    w, h = width * PLACES, height * PLACES
    triangle, count = np.full((h, w), -1, np.int32), np.zeros((h, w), np.uint8)
    corners = uv.astype(np.float64).reshape(-1, 3, 2) * (w, h)
    first = np.maximum(np.floor(corners.min(1) - 0.5).astype(int), 0)
    last = np.minimum(np.ceil(corners.max(1) + 0.5).astype(int), (w, h))
    for i, (a, b, c) in enumerate(corners):
        (x0, y0), (x1, y1) = first[i], last[i]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if x1 <= x0 or y1 <= y0 or area == 0:
            continue
        x, y = np.arange(x0, x1) + 0.5, (np.arange(y0, y1) + 0.5)[:, None]
        inside = [((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area for p, q in ((a, b), (b, c), (c, a))]
        low = np.minimum(np.minimum(inside[0], inside[1]), inside[2])
        window = (slice(y0, y1), slice(x0, x1))
        triangle[window][low >= -EDGE] = i
        count[window] += low > EDGE
    return triangle, count


def masks(surfaces, width, height):
    """Of each texel [h, w]: `full` (every place is covered), `overlap` (some place is covered twice), `share` (of the covered places, those
    in the plane of the centre's triangle)."""
    triangle, count = raster(surfaces["uv"], width, height)

    def blocks(places):
        return places.reshape(height, PLACES, width, PLACES).swapaxes(1, 2).reshape(height, width, -1)

    corner = surfaces["corner"].astype(np.float64).reshape(-1, 3, 3)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    offset = (normal * corner[:, 0]).sum(1)
    of_place = blocks(triangle)
    centre = of_place[..., (PLACES // 2) * (PLACES + 1)]  # the place next to the centre
    same_plane = ((normal[of_place] * normal[centre][..., None, :]).sum(-1) > 1 - 1e-6) & (np.abs(offset[of_place] - offset[centre][..., None]) < 1e-4)
    covered = of_place >= 0
    share = (same_plane & covered & (centre >= 0)[..., None]).sum(-1) / np.maximum(covered.sum(-1), 1)
    return {"full": covered.all(-1), "overlap": (blocks(count) > 1).any(-1), "share": share}


def coincident(surfaces, width, height):
    """[h, w]: the texel's centre lies on a second face in the same plane (within 0.1 mm). What such a texel sees is a matter of where
    rays start: relume starts a hair in front of the surface and sees past the second face, Cycles starts on it and sees nothing else."""
    corner = surfaces["corner"].astype(np.float64).reshape(-1, 3, 3)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    largest = np.abs(normal).argmax(1)
    normal *= np.sign(np.take_along_axis(normal, largest[:, None], 1))  # both sides of a plane count as one
    offset = (normal * corner[:, 0]).sum(1)

    triangle, _ = raster(surfaces["uv"], width, height)
    of_texel = triangle[PLACES // 2::PLACES, PLACES // 2::PLACES]
    y, x = np.nonzero(of_texel >= 0)
    own = of_texel[y, x]
    uv = surfaces["uv"].astype(np.float64).reshape(-1, 3, 2)[own] * (width, height)
    place = np.stack([x + 0.5 + 0.5 / PLACES, y + 0.5 + 0.5 / PLACES], 1)
    e1, e2, d = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0], place - uv[:, 0]
    area = e1[:, 0] * e2[:, 1] - e1[:, 1] * e2[:, 0]
    b1, b2 = (d[:, 0] * e2[:, 1] - d[:, 1] * e2[:, 0]) / area, (e1[:, 0] * d[:, 1] - e1[:, 1] * d[:, 0]) / area
    p = corner[own]
    point = p[:, 0] + b1[:, None] * (p[:, 1] - p[:, 0]) + b2[:, None] * (p[:, 2] - p[:, 0])

    found = np.zeros(len(own), bool)
    order = np.argsort(offset)
    by_triangle = np.argsort(own, kind="stable")
    first = np.searchsorted(own[by_triangle], np.arange(len(corner) + 1))
    for t in np.unique(own):
        near = order[np.searchsorted(offset[order], offset[t] - 1e-3):np.searchsorted(offset[order], offset[t] + 1e-3)]
        near = near[(near != t) & (largest[near] == largest[t]) & ((normal[near] * normal[t]).sum(1) > 1 - 1e-6)]
        if not len(near):
            continue
        texels = by_triangle[first[t]:first[t + 1]]
        axes = [a for a in range(3) if a != largest[t]]
        q = point[texels][:, axes]
        low, high = q.min(0), q.max(0)
        box = corner[near][:, :, axes]
        near = near[((box.min(1) <= high) & (box.max(1) >= low)).all(1)]
        for other in near:
            on_plane = np.abs(point[texels] @ normal[other] - offset[other]) < 1e-4
            a, b, c = corner[other][:, axes]
            size = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            inside = [((m[0] - k[0]) * (q[:, 1] - k[1]) - (m[1] - k[1]) * (q[:, 0] - k[0])) / size for k, m in ((a, b), (b, c), (c, a))]
            found[texels] |= on_plane & (np.min(inside, 0) > 1e-6)
    mask = np.zeros((height, width), bool)
    mask[y, x] = found
    return mask
