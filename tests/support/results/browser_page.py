"""Operations on a report's page in a browser."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

SCREEN = 900  # height, pixels
WAIT = 30.0  # s, enough for a slow machine that renders in software
COLOURS = """
const c = arguments[0], { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
return new Set(new Uint32Array(data.buffer)).size;
"""
PIXELS = "return arguments[0].toDataURL();"


def opened(browser: Any, folder: Path) -> None:
    """Open the report of a run from disk, and wait until it is laid out."""
    browser.get_log("browser")
    browser.get((folder / "report.html").as_uri())
    wait(browser, lambda: browser.find_element("css selector", "h1").text)


@contextmanager
def screen(browser: Any, width: int, height: int = SCREEN, **media: str) -> Iterator[None]:
    """Set a screen of this size in pixels; one narrower than 500 is a phone's.

    media: `shade` is the preferred colour scheme, `media` the type of medium
    """
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    features = [{"name": "prefers-color-scheme", "value": media.get("shade", "light")}]
    browser.execute_cdp_cmd(
        "Emulation.setEmulatedMedia", {"media": media.get("media", ""), "features": features}
    )
    try:
        yield
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})
        browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def unfold(browser: Any) -> None:
    """Open all parts that can be folded."""
    script = "for (const part of document.querySelectorAll('details.fold')) part.open = true;"
    browser.execute_script(script)


def wait(browser: Any, ready: Callable[[], Any]) -> Any:
    """Return what `ready` returns, once it is true."""
    from selenium.webdriver.support.ui import WebDriverWait

    return WebDriverWait(browser, WAIT).until(lambda _: ready())


def views(browser: Any, pin: str) -> list[Any]:
    """Return a pin's views, by its heading; all parts are unfolded first, as rendering waits for
    the layout of a long page.
    """
    unfold(browser)

    def headed() -> list[Any]:
        headings = browser.find_elements("css selector", "section.viewed h2")
        return [h for h in headings if h.get_attribute("textContent").strip() == f"Pin {pin}"]

    (heading,) = wait(browser, headed)
    return list(heading.find_elements("xpath", "ancestor::section[1]//*[@data-view]"))


def view(browser: Any, pin: str) -> Any:
    """Return a pin's first view, after scrolling to it and waiting until it is drawn."""
    root = views(browser, pin)[0]
    browser.execute_script("arguments[0].scrollIntoView();", root)
    wait(browser, lambda: part(root, "told").text)
    wait(browser, lambda: colours(browser, root) > 10)
    return root


def part(root: Any, name: str) -> Any:
    return root.find_element("css selector", f'[data-is="{name}"]')


def canvas(root: Any) -> Any:
    return root.find_element("css selector", "canvas")


def colours(browser: Any, root: Any) -> int:
    """Return the number of distinct colours that the view shows."""
    return int(browser.execute_script(COLOURS, canvas(root)))


def pixels(browser: Any, root: Any) -> str:
    return str(browser.execute_script(PIXELS, canvas(root)))


def maximum(root: Any) -> float:
    """Return the maximum that the view shows."""
    return float(part(root, "told").get_attribute("data-maximum"))


def slide(browser: Any, slider: Any, value: int) -> None:
    """Move a slider as a user does, as far as the page can tell."""
    script = "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'));"
    browser.execute_script(script, slider, value)


def errors(browser: Any) -> list[str]:
    """Return the errors of this page on the console; the page before it may log errors late, which
    are left out.
    """
    folder = browser.current_url.partition("#")[0].rpartition("/")[0]
    severe = (e["message"] for e in browser.get_log("browser") if e["level"] == "SEVERE")
    return [text for text in severe if text.startswith(folder) or not text.startswith("file:")]
