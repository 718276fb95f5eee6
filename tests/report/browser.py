"""Debian's Chromium without a window, spoken to by the DevTools protocol over a pipe. Python's own library is enough."""
import base64
import json
import os
import shutil
import subprocess
import tempfile
import time

PROGRAM = shutil.which("chromium")
OPTIONS = ["--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--remote-debugging-pipe",
           "--disable-gpu-compositing", "--no-first-run", "--hide-scrollbars", "--disable-background-networking"]

# What Chromium, which puts pages together without a graphics card, says of its own reading of what they drew.
READS_BACK = "GPU stall due to ReadPixels"

# Without a graphics card drawing takes nearly all of the time.
DRAWS_NOTHING = """
for (const context of [WebGLRenderingContext, WebGL2RenderingContext])
  for (const draw of ['drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'])
    if (draw in context.prototype) context.prototype[draw] = () => {};
const extension = WebGLRenderingContext.prototype.getExtension;
WebGLRenderingContext.prototype.getExtension = function (name) {
  const found = extension.call(this, name);
  if (name === 'ANGLE_instanced_arrays' && found) found.drawArraysInstancedANGLE = found.drawElementsInstancedANGLE = () => {};
  return found;
};
"""


class Browser:
    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix="elamin-browser-")
        to_browser, self.out = os.pipe()
        self.back, from_browser = os.pipe()

        def pipes():
            kept = os.dup(to_browser), os.dup(from_browser)
            os.dup2(kept[0], 3)
            os.dup2(kept[1], 4)

        self.process = subprocess.Popen([PROGRAM, *OPTIONS, f"--user-data-dir={self.profile}"], preexec_fn=pipes, close_fds=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser), os.close(from_browser)
        self.number, self.buffer, self.messages = 0, b"", []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    session = None

    def call(self, method, **parameters):
        """Sends a command and waits for its answer; what the page says meanwhile is kept in `messages`."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer.get("result", {})

    def receive(self):
        while b"\0" not in self.buffer:
            part = os.read(self.back, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self.buffer += part
        text, self.buffer = self.buffer.split(b"\0", 1)
        answer = json.loads(text)
        told = answer.get("params", {})
        if answer.get("method") == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(a.get("value", a.get("description"))) for a in told["args"]))
        elif answer.get("method") == "Runtime.exceptionThrown":
            details = told["exceptionDetails"]
            self.messages.append(details.get("exception", {}).get("description", details["text"]))
        elif answer.get("method") == "Log.entryAdded" and READS_BACK not in told["entry"]["text"]:
            self.messages.append(told["entry"]["text"])
        return answer

    def look(self, width, height, dark=False, scale=0.25):
        """The window, in pixels of the page, each of them `scale` pixels wide on the screen: few are drawn soon, and no number depends on them."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=False)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def open(self, file, drawn=False):
        """Opens a page. Unless drawn its shape is prepared, but not drawn: no number that is checked depends on that."""
        self.messages.clear()
        hook = None if drawn else self.call("Page.addScriptToEvaluateOnNewDocument", source=DRAWS_NOTHING)["identifier"]
        self.call("Page.navigate", url="file://" + os.path.abspath(file))
        self.until("document.readyState === 'complete' && typeof page === 'object' && page.run")
        if hook:
            self.call("Page.removeScriptToEvaluateOnNewDocument", identifier=hook)
            self.run("shape && (shape.render = () => {})")

    def run(self, script):
        """The value of an expression on the page."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", "an exception"))
        return result["result"].get("value")

    def until(self, script, seconds=120):
        end = time.monotonic() + seconds
        while True:
            try:
                if self.run(f"!!({script})"):
                    return
            except RuntimeError:
                pass
            if time.monotonic() > end:
                raise RuntimeError(f"in {seconds} s it did not come to: {script}; the page said: {self.messages}")
            time.sleep(0.05)

    def click(self, selector):
        """A click where the middle of an element is."""
        x, y = self.run(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}});"
                        " const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()")
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def picture(self, file, whole=True):
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(file, "wb") as out:
            out.write(base64.b64decode(data))

    def close(self):
        try:
            self.call("Browser.close")
        except RuntimeError:
            pass
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)
