// Pictures of a report for people who have not run the program: `node pictures.mjs REPORT.html JOB FOLDER` leaves page.png, peaks
// against speed beside its contents, and crossing.png, the player at the deepest frame of the job. scripts/pictures makes them.
import { join } from 'node:path';
import { launch, open } from './browser.mjs';

const [file, job, folder] = process.argv.slice(2);
const stop = await launch();
const { page, close } = await open({ file }, { width: 1280, height: 840, motion: 'reduce' });
await page.locator('#speed').evaluate(section => section.scrollIntoView());
await page.screenshot({ path: join(folder, 'page.png') });
await page.selectOption('#play-job', job);
await page.locator('.crossing').screenshot({ path: join(folder, 'crossing.png') });
await close();
await stop();
