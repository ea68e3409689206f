#!/usr/bin/env python3
"""What went over the link of lcm_link_run.sh: link_account.py FOLDER prints JSON of what spy counted, what lcm-logger's log
of the ground holds, what the service says it sent, and the bytes that left its interface."""
import json
import re
import sys

folder = sys.argv[1]


def load(name):
    with open(f"{folder}/{name}", encoding="utf-8") as file:
        return json.load(file)


spy, ground, sky = load("spy.json"), load("ground.json"), load("sky.json")
words, adds_up, lost_in_all = [], True, 0
for channel, told in sky["channels"].items():
    heard = spy["channels"][channel]
    # The log of the service contains everything; the network got all of it except what was withheld.
    sent = told["n_sent"] - told["n_held_back"]
    before, after = max(heard["first_sequence"] or 0, 0), sent - 1 - (heard["last_sequence"] if heard["received"] else -1)
    lost = heard["gaps"] + before + after if heard["received"] else sent
    logged = ground.get(channel, {"messages": 0, "missing": 0})
    adds_up = adds_up and lost + heard["received"] == sent and heard["received"] == logged["messages"]
    adds_up = adds_up and (not heard["received"] or heard["gaps"] == logged["missing"])
    lost_in_all += lost
    name = channel.rpartition("_")[2].lower()
    words.append(f"{name} {heard['received']} heard + {lost} lost = {sent} sent")
held = {channel.rpartition("_")[2].lower(): f"{told['n_held_back']} of {told['n_sent']}" for channel, told in sky["channels"].items()}

bytes_at = []
with open(f"{folder}/rate.jsonl", encoding="utf-8") as file:
    for text in file:
        if text.startswith("[") and text.rstrip().endswith("]"):  # the last one may be truncated
            bytes_at.append(json.loads(text)[0]["stats64"]["tx"]["bytes"])
steps = [b - a for a, b in zip(bytes_at, bytes_at[1:]) if b > a]
steps = steps[1:-1] if len(steps) > 10 else steps
mean, most = sum(steps) / max(1, len(steps)), max(steps, default=0)

with open(f"{folder}/spy.log", encoding="utf-8") as file:
    text = file.read()
screens = re.split(r"(?m)^MODES ", text)
modes = max([len(re.findall(r"(?m)^ +[0-9.]+ .* structural ", screen)) for screen in screens] or [0])
while_running = text[:text.rfind("hovermodal spy  stream")]  # estimates are shown then only when they are complete
estimates = set(re.findall(r"(?m)^MODES +estimate ([0-9]+)", while_running))
with open(f"{folder}/report/modal.json", encoding="utf-8") as file:
    report = json.load(file)
print(json.dumps({
    "modes": modes, "modes_sent": len(report["modes"]), "estimates": len(estimates),
    "estimates_sent": sky["estimates"],
    "words": ", ".join(words), "adds_up": adds_up, "lost": lost_in_all,
    "held_words": "held back: " + ", ".join(f"{name} {n}" for name, n in held.items()),
    "mean_kbit_s": round(mean * 8 / 1000, 1),
    "rate_words": f"mean {mean:.0f} bytes/s ({mean * 8 / 1000:.0f} kbit/s), most in a second {most} ({most * 8 / 1000:.0f} kbit/s), over {len(steps)} s"}, indent=1))
