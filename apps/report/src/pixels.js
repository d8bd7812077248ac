// The pixels of a picture that is given as a data URL.

/** ImageData of a picture; rejects with a sentence where it cannot be decoded. */
export async function loadPixels(url) {
    const image = new Image();
    image.src = url;
    try {
        await image.decode();
    } catch {
        throw new Error('a picture of the report cannot be decoded');
    }
    const canvas = document.createElement('canvas');
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
}

/** A canvas that shows ImageData pixel for pixel. */
export function paint(canvas, pixels) {
    canvas.width = pixels.width;
    canvas.height = pixels.height;
    canvas.getContext('2d').putImageData(pixels, 0, 0);
}
