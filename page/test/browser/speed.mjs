// How fast a page that follows a file is, as its reader sees it.

/** From a slider's event until a point has its new place in the document (ms): the median, and what 95 of 100 keep. */
export async function sliderToPicture(page, { param, from: least, to: greatest, point }, rounds) {
    const times = await page.evaluate(
        async ([param, least, greatest, point, rounds]) => {
            const slider = document.querySelector(`[data-param="${param}"]`);
            const picture = document.querySelector(".over");
            const place = () => picture.querySelector(`[data-point="${point}"]`).getAttribute("transform");
            const times = [];
            for (let round = 0; round < rounds; round++) {
                const before = place();
                const changed = new Promise((resolve) => {
                    const observer = new MutationObserver(() => {
                        if (place() === before) return;
                        observer.disconnect();
                        resolve();
                    });
                    observer.observe(picture, { subtree: true, attributes: true, childList: true });
                });
                const began = performance.now();
                slider.value = String(least + ((round % 40) / 40) * (greatest - least));
                slider.dispatchEvent(new Event("input", { bubbles: true }));
                await changed;
                times.push(performance.now() - began);
                await new Promise((resolve) => setTimeout(resolve, 30));
            }
            return times.sort((a, b) => a - b);
        },
        [param, least, greatest, point, rounds],
    );
    const at = (part) => times[Math.floor(part * times.length)];
    return { median: at(0.5), most: at(0.95) };
}
