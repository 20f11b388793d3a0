"""A page in Chromium without a window, by the DevTools protocol over a pipe: no driver and no Python package is needed.
SPDX-License-Identifier: Apache-2.0"""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

CHROMIUM = shutil.which("chromium")
WHY_NOT = None if CHROMIUM else "Chromium is not installed: the package chromium (ci/setup --verify installs it)"
TALLEST = 16_000   # pixels of a screenshot: textures are no larger


class Browser:
    """One browser with one tab. `complaints` collects errors of scripts, of loading and of the console since the last `open`."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory(prefix="spindrift_chromium_")
        ends = [*os.pipe(), *os.pipe()]
        theirs, self.put, self.get, back = (fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in ends)
        for end in ends:
            os.close(end)
        # The browser reads commands from descriptor 3 and writes answers to 4.
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{theirs} 4>&{back} {theirs}<&- {back}>&-', "bash", CHROMIUM, "--headless=new", "--no-sandbox",
                                         "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-sync", "--force-color-profile=srgb", "--disable-lcd-text", "--hide-scrollbars",
                                         "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}", "about:blank"],
                                        pass_fds=(theirs, back), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(theirs), os.close(back)
        self.number, self.rest, self.session, self.events, self.complaints = 0, b"", None, [], []
        target = next(t for t in self.ask("Target.getTargets")["targetInfos"] if t["type"] == "page")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(domain + ".enable")

    def close(self):
        try:
            self.session = None
            self.ask("Browser.close")
        except (OSError, RuntimeError):
            self.process.kill()
        self.process.wait()
        os.close(self.put), os.close(self.get)
        self.profile.cleanup()

    # ---- protocol -----------------------------------------------------------------------------------------------------------------------

    def _message(self, until):
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.get], [], [], max(0.0, until - time.monotonic()))
            if not ready:
                raise RuntimeError("the browser does not answer")
            more = os.read(self.get, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.rest += more
        text, _, self.rest = self.rest.partition(b"\0")
        return json.loads(text)

    def _note(self, event):
        what, about = event.get("method"), event.get("params", {})
        self.events.append(what)
        if what == "Runtime.exceptionThrown":
            self.complaints.append(about["exceptionDetails"].get("exception", {}).get("description", "exception"))
        elif what == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning"):
            self.complaints.append(" ".join(str(a.get("value", a.get("description"))) for a in about["args"]))
        elif what == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            self.complaints.append(about["entry"]["text"])
        elif what == "Network.loadingFailed":
            self.complaints.append("not loaded: " + about["errorText"])

    def ask(self, method, patience_s=120.0, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters} | ({"sessionId": self.session} if self.session else {})
        os.write(self.put, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + patience_s
        while True:
            answer = self._message(until)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._note(answer)

    # ---- a page -------------------------------------------------------------------------------------------------------------------------

    def open(self, path, width=1280, dark=False, scale=1):
        """Loads a file at a width [CSS pixels], in light or dark; the page is then laid out and all its folds are closed."""
        self.complaints, self.events = [], []
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.width, self.scale = width, scale
        self._size(900)
        self.ask("Page.navigate", url=path.resolve().as_uri())
        until = time.monotonic() + 120.0
        while "Page.loadEventFired" not in self.events:
            self._note(self._message(until))
        self.fit()

    def _size(self, height):
        self.ask("Emulation.setDeviceMetricsOverride", width=self.width, height=height, deviceScaleFactor=self.scale, mobile=False)

    def fit(self):
        """As high as the page is."""
        self._size(900)
        self.height = min(int(self.run("Math.ceil(document.documentElement.scrollHeight)")), TALLEST // self.scale)
        self._size(self.height)

    def run(self, script):
        """The value of an expression or of a promise, as Python."""
        answer = self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description", "exception"))
        return answer["result"].get("value")

    def screenshot(self, path):
        """The whole page as a PNG file, and as an array (height, width, 3) of 0 to 1."""
        import matplotlib.image
        path.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"]))
        return matplotlib.image.imread(path)[..., :3]

    def part(self, box):
        """The pixels of a box (left, top, right, bottom) of the page [CSS pixels], wherever on the page it lies."""
        import io
        import matplotlib.image
        left, top, right, bottom = box
        clip = {"x": left, "y": top, "width": right - left, "height": bottom - top, "scale": 1}
        data = self.ask("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)["data"]
        return matplotlib.image.imread(io.BytesIO(base64.b64decode(data)))[..., :3]
