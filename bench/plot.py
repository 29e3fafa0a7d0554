"""Line plots as SVG, with nothing but the standard library: what docs/performance.md shows."""
import html
import math

COLOURS = ["#2563eb", "#dc2626", "#059669", "#d97706", "#7c3aed", "#0891b2"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 400, 76, 20, 48, 58


def _ticks(lo, hi, log):
    if log:
        first, last = math.floor(math.log10(lo)), math.ceil(math.log10(hi))
        steps = (1,) if last - first > 3 else (1, 2, 5)
        return [s * 10.0**e for e in range(first, last + 1) for s in steps if lo * 0.999 <= s * 10.0**e <= hi * 1.001]
    span = (hi - lo) / 5 or 1
    step = 10.0**math.floor(math.log10(span))
    step *= next(m for m in (1, 2, 5, 10) if m * step >= span)
    return [step * i for i in range(math.ceil(lo / step), math.floor(hi / step) + 1)]


def _label(value):
    if value == 0:
        return "0"
    for scale, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= scale:
            return f"{value / scale:g}{unit}"
    return f"{value:g}"


def line_plot(title, x_label, y_label, series, log_x=False, log_y=False):
    """SVG text. `series`: list of (name, [(x, y), ...]); log axes need positive values."""
    xs = [x for _, points in series for x, _ in points]
    ys = [y for _, points in series for _, y in points]
    x_lo, x_hi, y_hi = min(xs), max(xs), max(ys)
    y_lo = min(ys) if log_y else 0.0
    if log_y:
        y_lo, y_hi = y_lo / 1.3, y_hi * 1.3
    else:
        y_hi *= 1.05
    if log_x:
        x_lo, x_hi = x_lo / 1.1, x_hi * 1.1

    def scale(value, lo, hi, log, start, length):
        if log:
            value, lo, hi = math.log(value), math.log(lo), math.log(hi)
        return start + length * (value - lo) / ((hi - lo) or 1)

    sx = lambda x: scale(x, x_lo, x_hi, log_x, LEFT, WIDTH - LEFT - RIGHT)
    sy = lambda y: scale(y, y_lo, y_hi, log_y, HEIGHT - BOTTOM, -(HEIGHT - TOP - BOTTOM))
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="system-ui, sans-serif" font-size="12">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>',
           f'<text x="{LEFT}" y="26" font-size="15" font-weight="600" fill="#111">{html.escape(title)}</text>']
    for x in _ticks(x_lo, x_hi, log_x):
        out.append(f'<line x1="{sx(x):.1f}" x2="{sx(x):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#e5e7eb"/>')
        out.append(f'<text x="{sx(x):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle" fill="#444">{_label(x)}</text>')
    for y in _ticks(y_lo, y_hi, log_y):
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{sy(y):.1f}" y2="{sy(y):.1f}" stroke="#e5e7eb"/>')
        out.append(f'<text x="{LEFT - 8}" y="{sy(y) + 4:.1f}" text-anchor="end" fill="#444">{_label(y)}</text>')
    out.append(f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}" fill="none" stroke="#9ca3af"/>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 16}" text-anchor="middle" fill="#111">{html.escape(x_label)}</text>')
    # The names stand in the upper corner that less of the lines is in.
    on_lines = [(sx(a[0]) + t / 16 * (sx(b[0]) - sx(a[0])), sy(a[1]) + t / 16 * (sy(b[1]) - sy(a[1])))
                for _, points in series for a, b in zip(points, points[1:] or points) for t in range(17)]
    upper = [x for x, y in on_lines if y < TOP + 18 * len(series) + 24]
    legend = LEFT if sum(x < WIDTH / 2 for x in upper) <= sum(x >= WIDTH / 2 for x in upper) else WIDTH - RIGHT - 190
    middle = (TOP + HEIGHT - BOTTOM) / 2
    out.append(f'<text x="18" y="{middle}" text-anchor="middle" fill="#111" transform="rotate(-90 18 {middle})">{html.escape(y_label)}</text>')
    for i, (name, points) in enumerate(series):
        colour = COLOURS[i % len(COLOURS)]
        path = " ".join(f"{sx(x):.1f},{sy(y):.1f}" for x, y in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{sx(x):.1f}" cy="{sy(y):.1f}" r="3" fill="{colour}"/>' for x, y in points]
        if len(series) > 1:
            out.append(f'<rect x="{legend + 12}" y="{TOP + 12 + 18 * i}" width="14" height="3" fill="{colour}"/>')
            out.append(f'<text x="{legend + 32}" y="{TOP + 18 + 18 * i}" fill="#111">{html.escape(name)}</text>')
    out.append("</svg>\n")
    return "\n".join(out)
