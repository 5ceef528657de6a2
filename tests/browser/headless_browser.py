"""A Chromium without a window, driven through its DevTools protocol. Standard library only."""

import json
import os
import select
import shutil
import subprocess
import tempfile
import time

START_SECONDS = 60  # of a machine that is busy with other tests
REPLY_SECONDS = 120


class BrowserError(Exception):
    pass


def find_browser():
    for name in ["chromium", "chromium-browser", "google-chrome"]:
        if path := shutil.which(name):
            return path
    return None


class Browser:
    """A context manager. Messages are JSON, each ended by a zero byte, on two pipes."""

    def __init__(self, *arguments):
        self.arguments = arguments

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.commands = os.pipe()
        self.replies, from_browser = os.pipe()
        command = [find_browser(), "--headless=new", "--no-sandbox", "--remote-debugging-pipe",
                   f"--user-data-dir={self.profile.name}",
                   # The processor draws: the same picture everywhere, and no graphics needed.
                   "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                   "--no-first-run", "--disable-background-networking", "--disable-sync",
                   "--disable-component-update", "--disable-default-apps", "--disable-extensions",
                   "--disable-dev-shm-usage", *self.arguments]

        def wire():
            # It reads from 3 and writes to 4. Ours may have these numbers: first out of the way.
            reading, writing = os.dup2(to_browser, 20), os.dup2(from_browser, 21)
            os.dup2(reading, 3)
            os.dup2(writing, 4)
        self.process = subprocess.Popen(command, preexec_fn=wire, close_fds=False,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer = b""
        self.last_id = 0
        self.events = []
        try:
            self.call("Browser.getVersion", seconds=START_SECONDS)
        except BrowserError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *exception):
        os.close(self.commands)  # which it takes as the order to end
        try:
            self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.replies)
        self.profile.cleanup()

    def call(self, method, session=None, seconds=REPLY_SECONDS, **parameters):
        """The result of a command; what happens meanwhile is added to `events`."""
        self.last_id += 1
        message = {"id": self.last_id, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        try:
            data = json.dumps(message).encode() + b"\0"
            while data:
                data = data[os.write(self.commands, data):]
        except BrokenPipeError:
            raise BrowserError("the browser has ended") from None
        end = time.monotonic() + seconds
        while True:
            reply = self.receive(end, method)
            if reply.get("id") == self.last_id:
                if "error" in reply:
                    raise BrowserError(f"{method}: {reply['error']}")
                return reply["result"]
            self.events.append(reply)

    def receive(self, end, awaited):
        while b"\0" not in self.buffer:
            if not select.select([self.replies], [], [], max(end - time.monotonic(), 0))[0]:
                raise BrowserError(f"no reply to {awaited}")
            part = os.read(self.replies, 1 << 20)
            if not part:
                raise BrowserError("the browser has ended")
            self.buffer += part
        message, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(message)


class Tab:
    """A page in a browser, and what it asked for and complained about since it was opened.
    `script` runs before those of the page."""

    def __init__(self, browser, address, width=800, height=600, script=""):
        self.browser = browser
        self.target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=self.target,
                                    flatten=True)["sessionId"]
        for domain in ["Network", "Runtime", "Log", "Page"]:
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=False)
        self.call("Page.addScriptToEvaluateOnNewDocument", source=script)
        self.call("Page.navigate", url=address)
        self.evaluate("new Promise((resolve) => document.readyState === 'complete' ? resolve(true)"
                      " : addEventListener('load', () => setTimeout(() => resolve(true))))")

    def call(self, method, **parameters):
        return self.browser.call(method, session=self.session, **parameters)

    def evaluate(self, expression):
        """The value of JavaScript; of a promise, once it is kept."""
        reply = self.call("Runtime.evaluate", expression=expression, awaitPromise=True,
                          returnByValue=True)
        if "exceptionDetails" in reply:
            raise BrowserError(f"{expression}: {reply['exceptionDetails']}")
        return reply["result"].get("value")

    def text(self, name):
        return self.evaluate(f"document.getElementById('{name}').textContent")

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)

    def seen(self, method):
        return [event["params"] for event in self.browser.events
                if event.get("sessionId") == self.session and event["method"] == method]

    def requests(self):
        return [event["request"]["url"] for event in self.seen("Network.requestWillBeSent")]

    def complaints(self):
        """Errors and warnings of the page, WebGL's included; its advice on speed is none."""
        entries = [event["entry"] for event in self.seen("Log.entryAdded")]
        return ([entry["text"] for entry in entries
                 if entry["level"] in ("warning", "error") and "Performance" not in entry["text"]]
                + [str(event["exceptionDetails"]) for event in self.seen("Runtime.exceptionThrown")])
