"""Centroids of the 28 dark dots in the photographs of the three-storey frame: blobs below a gray level, weighted by their darkness.
Shares nothing with the tracker that is measured against them."""
import subprocess

import numpy
from scipy import ndimage

from table import KitError

WIDTH, HEIGHT, PER_ROW = 1300, 2046, 7
ROWS_V = [1904, 1420, 931, 471]  # nominal, px; row 0 = base
COLUMNS_U = [148, 310, 466, 625, 778, 940, 1111]
HALF_STRIP, MARGIN = 60, 6  # px
AREA = (80, 900)  # px^2
LEVELS = (40, 55, 30)  # gray; the next one is tried where a dot is not found
BEND = 25.0  # px by which a dot may be displaced relative to the first one of its row


def blobs(strip, level):
    """u, v of every round dark blob of a strip."""
    labels, n = ndimage.label(strip < level)
    areas = numpy.bincount(labels.ravel(), minlength=n + 1)
    found = []
    for i, (rows, columns) in enumerate(ndimage.find_objects(labels), 1):
        high, wide = rows.stop - rows.start, columns.stop - columns.start
        if not AREA[0] < areas[i] < AREA[1] or max(high, wide) > 1.6 * min(high, wide) or areas[i] < 0.6 * high * wide:
            continue
        top, left = max(rows.start - MARGIN, 0), max(columns.start - MARGIN, 0)
        window = (slice(top, rows.stop + MARGIN), slice(left, columns.stop + MARGIN))
        gray = strip[window].astype(float)
        near = ndimage.binary_dilation(labels[window] == i, iterations=4)
        paper = numpy.median(gray[~near])
        weight = numpy.where(near, numpy.clip(paper - 20 - gray, 0, None), 0)
        if not weight.any():
            continue
        v, u = numpy.mgrid[:gray.shape[0], :gray.shape[1]]
        found.append((left + (u * weight).sum() / weight.sum(), top + (v * weight).sum() / weight.sum()))
    return numpy.array(found).reshape(-1, 2)


def row_of_dots(strip, before):
    """The seven blobs that lie to each other as the row did before, wherever it went; None where there are none."""
    for level in LEVELS:
        found = blobs(strip, level)
        best, least = None, BEND
        for shift in found - before[0] if len(found) >= PER_ROW else ():
            apart = numpy.hypot(*(found[None] - (before + shift)[:, None]).transpose(2, 0, 1))
            nearest = apart.argmin(axis=1)
            if len(set(nearest)) == PER_ROW and apart.min(axis=1).max() < least:
                best, least = found[nearest], apart.min(axis=1).max()
        if best is not None:
            return best
    return None


def frames(photographs):
    command = ["ffmpeg", "-v", "error", "-i", str(photographs / "IMG%05d.jpg"), "-vf", "extractplanes=y", "-f", "rawvideo", "-pix_fmt", "gray", "-"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as child:
        while len(data := child.stdout.read(WIDTH * HEIGHT)) == WIDTH * HEIGHT:
            yield numpy.frombuffer(data, numpy.uint8).reshape(HEIGHT, WIDTH)


def centroids(photographs):
    """Lines of the table: frame from 1, then u and v of each dot, row by row from the base."""
    tops = [v - HALF_STRIP for v in ROWS_V]
    rows = [numpy.array([(u, HALF_STRIP) for u in COLUMNS_U], float) for _ in ROWS_V]
    for number, image in enumerate(frames(photographs), 1):
        cells = []
        for r, top in enumerate(tops):
            dots = row_of_dots(image[top:top + 2 * HALF_STRIP], rows[r])
            if dots is None:
                raise KitError(f"photograph {number}: the seven dots of row {r} were not found")
            rows[r] = dots
            cells += [f"{u:.3f},{v + top:.3f}" for u, v in dots]
        if number % 100 == 0:
            print(f"  {number} photographs", flush=True)
        yield f"{number}," + ",".join(cells)
