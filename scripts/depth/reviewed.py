"""Lists that people have read: entries "key: value", one per line, entries apart by an empty line. And exact intervals."""
import math


def entries(path, keys):
    """The entries of a list, each with exactly these keys. A text that goes on stands on the next line, indented."""
    out, entry, last = [], {}, None
    for number, text in enumerate([*path.read_text().splitlines(), ""], 1):
        if text.startswith("#"):
            continue
        if not text.strip():
            if entry:
                if set(entry) != set(keys):
                    raise SystemExit(f"{path}:{number - 1}: an entry has the keys {', '.join(keys)}, here: {', '.join(entry)}")
                out.append(entry)
            entry, last = {}, None
        elif text.startswith(" ") and last:
            entry[last] += " " + text.strip()
        else:
            key, separator, value = text.partition(": ")
            if not separator or key not in keys or key in entry:
                raise SystemExit(f"{path}:{number}: not one of {', '.join(keys)}, once each: {text}")
            entry[key], last = value.strip(), key
    return out


def _tail(k, n, p):
    """P(X >= k) of a binomial variable."""
    if p <= 0.0 or p >= 1.0:
        return 1.0 if k <= 0 or p >= 1.0 else 0.0
    logs = (math.lgamma(n + 1) - math.lgamma(i + 1) - math.lgamma(n - i + 1) + i * math.log(p) + (n - i) * math.log1p(-p)
            for i in range(max(k, 0), n + 1))
    return min(1.0, math.fsum(math.exp(x) for x in logs))


def clopper_pearson(k, n, miss=0.05):
    """The interval of k of n, by bisection."""
    def where(wanted, of):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if _tail(of, n, middle) < wanted else (low, middle)
        return (low + high) / 2
    if n == 0:
        return 0.0, 1.0
    return (0.0 if k == 0 else where(miss / 2, k)), (1.0 if k == n else where(1 - miss / 2, k + 1))


def share(k, n):
    """`k of n (95 %: a to b %)`, rounded outwards; `(97.5 %: at most b %)` where k is 0, `at least` where it is n."""
    low, high = clopper_pearson(k, n)
    low, high = math.floor(1e4 * low) / 100, math.ceil(1e4 * high) / 100
    if k in (0, n) and n > 0:
        return f"{k} of {n} (97.5 %: " + (f"at most {high:.2f} %)" if k == 0 else f"at least {low:.2f} %)")
    return f"{k} of {n} (95 %: {low:.2f} to {high:.2f} %)"
