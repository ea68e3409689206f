# Figure 1 of exchange.sh: what `hovermodal export` wrote, read by pyuff, scipy.io, mcap and Python's csv, against the run's own
# modal.json, displacements.csv and tracks.csv.
#   exchange_readers.py FOLDER RUN...     FOLDER/RUN is a run's folder, FOLDER/RUN.FORMAT its export
# Prints "FORMAT <tab> NUMBERS COMPARED <tab> NUMBERS THAT DIFFER <tab> READER", or "FORMAT <tab> SKIP <tab> - <tab> WHY".
import collections
import csv
import json
import math
import os
import sys
import warnings

warnings.simplefilter("ignore")
Run = collections.namedtuple("Run", "modal names rate unit times values places delays")


class Count:
    def __init__(self):
        self.n = self.different = 0

    def same(self, found, expected, digits=None):
        """Equal as doubles, or, with digits, as that many significant decimal ones. NaN and None are equal."""
        self.n += 1
        found, expected = (math.nan if x is None else float(x) for x in (found, expected))
        if math.isnan(found) and math.isnan(expected):
            return
        if digits is None:
            equal = found == expected
        else:
            text = "%." + str(digits - 1) + "E"
            equal = text % found == text % (expected + 0.0) or found == expected == 0
        if not equal:
            self.different += 1
            print(f"# differs: {found!r} instead of {expected!r}", file=sys.stderr)

    def equal(self, found, expected):
        self.n += 1
        if found != expected:
            self.different += 1
            print(f"# differs: {found!r} instead of {expected!r}", file=sys.stderr)


def read_modal(*folder):
    with open(os.path.join(*folder, "modal.json"), encoding="utf-8") as file:
        return json.load(file)


def read_run(folder):
    modal = read_modal(folder)
    comments, rows = {}, []
    with open(os.path.join(folder, "displacements.csv"), encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                key, _, value = line[1:].strip().partition(": ")
                comments[key] = value
            else:
                rows.append(line.rstrip("\n").split(","))
    number = [[float(cell) if cell else math.nan for cell in row] for row in rows[1:]]
    names = rows[0][3:]
    scale = 1.0 if comments["unit"] == "px" else next(row[2] for row in number if row[2] > 0)
    sums = {}
    with open(os.path.join(folder, "tracks.csv"), encoding="utf-8") as file:
        table = csv.DictReader(line for line in file if not line.startswith("#"))
        for row in table:
            first = sums.setdefault("frame", row["frame"])
            if row["frame"] != first:
                break
            one = sums.setdefault(("region", row["region"]), [0.0, 0.0, 0])
            one[0] += float(row["u_px"])
            one[1] += float(row["v_px"])
            one[2] += 1
    places = {key[1]: (scale * s[0] / s[2], -scale * s[1] / s[2]) for key, s in sums.items() if key != "frame"}
    delays = [float(comments.get("row_delay_s." + name, 0)) for name in names]
    values = [[row[3 + c] for row in number] for c in range(len(names))]
    return Run(modal, names, float(comments["rate_hz"]), comments["unit"], [row[1] for row in number], values, places, delays)


def shape_of(run, mode, name):
    """None: unknown."""
    takes_part = {c["name"]: c["takes_part"] for c in run.modal["channels"]}
    value = mode["shape"].get(name)
    return None if value is None or not takes_part.get(name, True) else complex(*value)


def check_csv(path, run, count):
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    count.equal(len(rows), len(run.modal["modes"]))
    for row, mode in zip(rows, run.modal["modes"]):
        for column, key in (("frequency_hz",) * 2, ("frequency_sigma_hz", "frequency_std_hz"), ("damping", "damping_ratio"),
                            ("damping_sigma", "damping_std"), ("mpc", "mpc")):
            count.same(row[column] or None, mode[key])
        for name in run.names:
            value = shape_of(run, mode, name)
            count.same(row[name + ".re"] or None, None if value is None else value.real)
            count.same(row[name + ".im"] or None, None if value is None else value.imag)
            if value is not None and mode.get("shape_std"):
                count.same(row[name + ".sigma"] or None, mode["shape_std"][name])


def check_mat(path, run, count):
    import scipy.io
    mat = scipy.io.loadmat(path, squeeze_me=False)
    texts = lambda name: [str(cell[0]) for cell in mat[name][:, 0]]
    count.equal(texts("channel_names"), run.names)
    count.equal(str(mat["unit"][0]), run.unit)
    count.same(mat["rate_hz"][0, 0], run.rate)
    for k, t in enumerate(run.times):
        count.same(mat["t_s"][k, 0], t)
        for c in range(len(run.names)):
            count.same(mat["displacement"][k, c], run.values[c][k])
    for c, delay in enumerate(run.delays):
        count.same(mat["delay_s"][c, 0], delay)
    nodes = texts("node_names")
    for n, name in enumerate(nodes):
        for axis in range(2):
            count.same(mat["node_xy"][n, axis], run.places[name][axis], 14)
    for m, mode in enumerate(run.modal["modes"]):
        for variable, key in (("frequency_hz",) * 2, ("frequency_sigma_hz", "frequency_std_hz"), ("damping", "damping_ratio"),
                              ("damping_sigma", "damping_std"), ("mpc", "mpc")):
            count.same(mat[variable][m, 0], mode[key])
        for c, name in enumerate(run.names):
            value = shape_of(run, mode, name)
            count.same(mat["shape"][c, m].real, None if value is None else value.real)
            count.same(mat["shape"][c, m].imag, None if value is None else value.imag)
            if value is not None and mode.get("shape_std"):
                count.same(mat["shape_sigma"][c, m], mode["shape_std"][name])
    return mat


def check_mcap(path, run, count, mat):
    from mcap.reader import make_reader
    topics = collections.defaultdict(list)
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        for schema, channel, message in reader.iter_messages():
            count.equal((schema.encoding, channel.message_encoding), ("jsonschema", "json"))
            json.loads(schema.data)
            topics[channel.topic].append((message.log_time, json.loads(message.data)))
    count.equal(summary.statistics.message_count, sum(len(messages) for messages in topics.values()))
    count.equal(len(topics["/displacement"]), len(run.times))
    for k, (t_ns, message) in enumerate(topics["/displacement"]):
        count.equal(t_ns, round(1e9 * (run.times[k] - run.times[0])))
        count.same(message["t_s"], run.times[k])
        for c, name in enumerate(run.names):
            count.same(message["channel"][name], run.values[c][k])
    modes = topics["/modes"][0][1]["mode"]
    count.equal(len(modes), len(run.modal["modes"]))
    for found, mode in zip(modes, run.modal["modes"]):
        for field, key in (("frequency_hz",) * 2, ("frequency_sigma_hz", "frequency_std_hz"), ("damping", "damping_ratio"),
                           ("damping_sigma", "damping_std"), ("mpc", "mpc")):
            count.same(found[field], mode[key])
        for component in found["shape"]:
            value = shape_of(run, mode, component["channel"])
            count.same(component["re"], None if value is None else value.real)
            count.same(component["im"], None if value is None else value.imag)
    if mat is None:
        return
    for topic, variable in (("/spectrum", "spectrum"), ("/correlation", "correlation")):
        for p, pair in enumerate(topics[topic][0][1]["pair"]):
            for k, value in enumerate(pair["re"]):
                count.same(value, mat[variable][k, p].real)
            for k, value in enumerate(pair.get("im", [])):
                count.same(value, mat[variable][k, p].imag)


def check_uff(path, run, count, mat):
    import pyuff
    sets = pyuff.UFF(path).read_sets()
    of = lambda number: [one for one in sets if one["type"] == number]
    count.equal([len(of(number)) for number in (151, 164, 15)], [1, 1, 1])
    count.same(of(164)[0]["length"], 1000.0 if run.unit == "mm" else 1.0)
    regions = []
    for name in run.names:
        region = name if name in run.places else name[:-2]
        if region not in regions:
            regions.append(region)
    for n, region in enumerate(regions):
        count.same(of(15)[0]["node_nums"][n], n + 1)
        count.same(of(15)[0]["x"][n], run.places[region][0], 6)
        count.same(of(15)[0]["y"][n], run.places[region][1], 6)
    count.equal(sorted(of(82)[0]["nodes"]), [n + 1 for n in range(len(regions))])
    count.equal(len(of(55)), len(run.modal["modes"]))
    for found, mode in zip(of(55), run.modal["modes"]):
        w, zeta = 2 * math.pi * mode["frequency_hz"], mode["damping_ratio"]
        count.same(found["eig"].real, -zeta * w, 6)
        count.same(found["eig"].imag, w * math.sqrt(1 - zeta * zeta), 6)
        for text, value, sigma in ((found["id3"], mode["frequency_hz"], mode["frequency_std_hz"]),
                                   (found["id4"], zeta, mode["damping_std"])):
            words = text.replace(",", "").split()
            count.same(words[1], value)
            count.same(words[3] if words[3] != "unknown" else None, sigma)
        for n, region in enumerate(regions):
            known = [name for name in run.names if name in (region, region + ".u", region + ".v") and shape_of(run, mode, name) is not None]
            count.equal(n + 1 in found["node_nums"], bool(known))
            if not known:
                continue
            at = list(found["node_nums"]).index(n + 1)
            parts = {"r1": 0j, "r2": 0j}
            for name in known:
                x, y = direction(run, name)
                parts["r1"] += shape_of(run, mode, name) * x
                parts["r2"] += shape_of(run, mode, name) * y
            for key, value in parts.items():
                count.same(found[key][at].real, value.real, 6)
                count.same(found[key][at].imag, value.imag, 6)
    functions = of(58)
    series = [one for one in functions if one["func_type"] == 1]
    count.equal([one["id1"] for one in series], run.names)
    for one, values in zip(series, run.values):
        seen = [k for k, value in enumerate(values) if not math.isnan(value)]
        count.equal(len(one["data"]), len(seen))
        for found_t, found, k in zip(one["x"], one["data"], seen):
            count.same(found, values[k], 13)
            count.same(found_t, run.times[k], 6 if one["abscissa_spacing"] == 0 else 5)
    if mat is None:
        return
    for types, variable in (((3, 9), "spectrum"), ((7, 8), "correlation")):
        for p, one in enumerate(one for one in functions if one["func_type"] in types):
            for k, value in enumerate(one["data"]):
                count.same(value.real, mat[variable][k, p].real, 13)
                if one["func_type"] == 3:
                    count.same(value.imag, mat[variable][k, p].imag, 13)


def direction(run, name):
    axis = next((a["axis"] for a in run.modal["axes"] if a["region"] == name), None)
    if axis is None:
        axis = name[-1]
    angle = {"u": 0.0, "v": 90.0}.get(axis)
    angle = math.radians(float(axis.split()[0]) if angle is None else angle)
    return math.cos(angle), -math.sin(angle)


def check_identify(folder, name, count):
    own = read_modal(folder, name + ".own.report")
    for suffix in (".uff.report", ".mat.report"):
        other = read_modal(folder, name + suffix)
        count.equal(len(other["modes"]), len(own["modes"]))
        for found, expected in zip(other["modes"], own["modes"]):
            for key in ("frequency_hz", "damping_ratio", "frequency_std_hz"):
                count.same(found[key], expected[key])


def reader_name(module):
    """Its name with its version; raises ImportError where it cannot be used."""
    __import__({"scipy": "scipy.io", "mcap": "mcap.reader"}.get(module, module))
    version = getattr(sys.modules[module], "__version__", "")
    return f"{module} {version}".strip()


def main():
    folder, names = sys.argv[1], sys.argv[2:]
    runs = {name: read_run(os.path.join(folder, name)) for name in names}
    mats = dict.fromkeys(names)
    for suffix, module in (("csv", "csv"), ("mat", "scipy"), ("mcap", "mcap"), ("uff", "pyuff")):
        try:
            reader = reader_name(module)
        except ImportError as error:
            print(suffix, "SKIP", "-", f"{module} is not there: {error}", sep="\t")
            continue
        count = Count()
        for name in names:
            path = os.path.join(folder, f"{name}.{suffix}")
            if suffix == "csv":
                check_csv(path, runs[name], count)
            elif suffix == "mat":
                mats[name] = check_mat(path, runs[name], count)
            elif suffix == "mcap":
                check_mcap(path, runs[name], count, mats[name])
            else:
                check_uff(path, runs[name], count, mats[name])
        print(suffix, count.n, count.different, f"{suffix} read back by {reader}, to the last digit that the format holds", sep="\t")
    count = Count()
    for name in names:
        check_identify(folder, name, count)
    print("identify", count.n, count.different, "modes that hovermodal identify finds in the uff and the mat, against those in displacements.csv", sep="\t")


main()
